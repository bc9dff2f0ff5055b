use quadrotor::Configuration;

use super::{Change, ParameterTable, Source};
use crate::identity::Identity;
use crate::parameters::{FileFormat, ParameterValues, SetError, Speed, Statistics, Value, parse, render};
use crate::vehicle::Conduct;

fn defaults() -> (ParameterTable, ParameterValues) {
    let (configuration, conduct) = (Configuration::default(), Conduct::new(false));
    let values = ParameterValues {
        configuration,
        conduct,
        system_id: 7,
        speed: Speed::Factor(1.0),
        statistics: Statistics::default(),
    };
    (ParameterTable::new(Identity::Px4), values)
}

#[test]
fn what_is_set_is_read_again_and_a_refusal_changes_nothing() {
    let (table, mut values) = defaults();
    for (id, value, expected) in [
        ("FRAME_MASS", 0.8, Ok(Change::ClosedLoop)),
        ("FRAME_MASS", f64::from(0.8_f32), Ok(Change::Nothing)),
        ("MIS_TAKEOFF_ALT", 4.0, Ok(Change::Conduct)),
        ("SIM_SPEEDUP", 5.0, Ok(Change::Speed)),
        ("MAV_SYS_ID", 7.0, Ok(Change::Nothing)),
        ("MAV_SYS_ID", 8.0, Err(())),
        ("MPC_THR_HOVER", 0.5, Err(())),
        ("SIM_SPEEDUP", -2.0, Err(())),
        ("FRAME_MASS", f64::NAN, Err(())),
        ("COM_OBL_RC_ACT", 8.0, Err(())),
        ("NO_SUCH", 1.0, Err(())),
    ] {
        let before = values;
        assert_eq!(table.set(id, value, &mut values).map_err(|_| ()), expected, "{id} = {value}");
        match table.index_of(id).and_then(|index| table.value(index, &values)).map(Value::number) {
            Some(present) if expected.is_ok() => assert!((present - value).abs() < 1e-6, "{id}"),
            _ => assert_eq!(values, before, "{id} = {value}"),
        }
    }
}

/// More mass needs stronger rotors, in whichever order a file has them.
#[test]
fn values_that_only_fit_together_come_in_any_order() {
    let (table, start) = defaults();
    let index = table.index_of("ROTOR_THRUST_K").expect("there");
    let k1 = table.value(index, &start).expect("there").number();
    let (heavy, strong) = ("FRAME_MASS 5", format!("ROTOR_THRUST_K {}", 8.0 * k1));
    let mut values = start;
    assert_eq!(table.set("FRAME_MASS", 5.0, &mut values.clone()), Ok(Change::ClosedLoop));
    let refused = table.set_checked("FRAME_MASS", 5.0, &mut values).expect_err("too heavy");
    assert!(matches!(&refused, SetError::Refused { name, .. } if name == "FRAME_MASS"), "{refused}");
    assert_eq!(values, start);
    for text in [format!("{heavy}\n{strong}"), format!("{strong}\n{heavy}")] {
        let mut values = start;
        parse(&text, &table, &mut values).expect("both");
        assert_eq!(values.configuration.airframe.mass_kg, 5.0);
        let mut again = start;
        parse(&render(FileFormat::Plain, &table, &values), &table, &mut again).expect("what was written");
        assert_eq!(render(FileFormat::Plain, &table, &again), render(FileFormat::Plain, &table, &values));
    }
    assert!(
        parse(heavy, &table, &mut values).expect_err("alone").to_string().starts_with("line 1: FRAME_MASS")
    );
}

#[test]
fn a_refusal_names_value_unit_range_and_remedy() {
    let table = ParameterTable::new(Identity::Px4);
    let (_, start) = defaults();
    for (name, value, expected) in [
        ("LIM_TILT", 45.0, "LIM_TILT = 45 rad; allowed 0.05–1.2 rad (3°–69°)"),
        ("limits.tilt", f64::from(0.01_f32), "limits.tilt = 0.01 rad; allowed 0.05–1.2 rad (3°–69°)"),
        (
            "FRAME_MASS",
            3.0,
            "FRAME_MASS: airframe.mass = 3 kg is too heavy; allowed up to 1.78 kg, which these rotors carry; lower it, or raise airframe.rotor.speed_max",
        ),
        ("C_ATT_N", 2.5, "C_ATT_N = 2.5; allowed whole numbers 1–20"),
        ("CTRL_KIND", 4.0, "CTRL_KIND = 4; allowed 1 (lmpc), 2 (ssmpc), 3 (dlqr)"),
        (
            "COM_ACT_FAIL_ACT",
            5.0,
            "COM_ACT_FAIL_ACT = 5; allowed 0 (Warn), 1 (Hold), 2 (Land), 3 (Return), 4 (Terminate)",
        ),
        ("COM_WIND_MAX", 60.0, "COM_WIND_MAX = 60 m/s; allowed -1 to 50 m/s"),
        ("BAT_LOW_THR", 2.0, "BAT_LOW_THR = 2; allowed 0–0.9"),
        ("SIM_SPEEDUP", -2.0, "SIM_SPEEDUP = -2; allowed 0 (paused), 0.01–1000, -1 (as fast as possible)"),
        ("MAV_SYS_ID", 9.0, "MAV_SYS_ID is read-only: restart with --system-id"),
        ("airframe.mas", 1.0, "unknown parameter airframe.mas; did you mean airframe.mass?"),
        ("FRAME_MAS", 1.0, "unknown parameter FRAME_MAS; did you mean FRAME_MASS?"),
        ("AF_MAS", 1.0, "unknown parameter AF_MAS; did you mean FRAME_MASS?"),
        ("com_wind_max", 1.0, "unknown parameter com_wind_max; did you mean COM_WIND_MAX?"),
        ("LOIT_SPEED", 1.0, "unknown parameter LOIT_SPEED; did you mean MPC_VEL_MANUAL?"),
        ("NO_SUCH", 1.0, "unknown parameter NO_SUCH"),
    ] {
        let mut values = start;
        let refused = table.set_checked(name, value, &mut values).expect_err(name);
        assert_eq!(refused.to_string(), expected);
        assert_eq!(values, start, "{name}");
    }
}

/// ArduPilot takes what is beyond a documented range; here, too, where it means something.
#[test]
fn ardupilots_ranges_are_no_limits() {
    let table = ParameterTable::new(Identity::ArduPilot);
    let start = ParameterValues { conduct: Conduct::new(true), ..defaults().1 };
    for (name, value, told) in [
        ("PILOT_SPD_UP", 30.0, Some(30.0)),
        ("WPNAV_RADIUS", 200_000.0, Some(200_000.0)),
        ("PILOT_TKO_ALT_M", 25.0, Some(25.0)),
        ("FOLL_OFS_X", -150.0, Some(-150.0)),
        // Without effect, and rounded.
        ("ATC_RAT_RLL_P", 7.0, Some(7.0)),
        ("BATT_CURR_PIN", 150.4, Some(150.0)),
        // A radius of zero is no waypoint's, and no number is none.
        ("WPNAV_RADIUS", 0.0, None),
        ("PILOT_SPD_UP", f64::NAN, None),
        ("ATC_RAT_RLL_P", f64::INFINITY, None),
    ] {
        let mut values = start;
        let set = table.set(name, value, &mut values);
        assert_eq!(set.is_ok(), told.is_some(), "{name} = {value}: {set:?}");
        let shown = table.find(name).expect(name).value(&values).number();
        assert!(told.is_none_or(|told: f64| (shown - told).abs() < 1e-3), "{name} = {shown}");
    }
}

/// Clients and files have single precision, in which a bound may lie a little beyond itself. What they set there is
/// accepted, is the bound itself, and is read back as they wrote it, over the protocol and from a file.
#[test]
fn both_ends_of_every_range_can_be_set_in_single_precision() {
    for identity in [Identity::Px4, Identity::ArduPilot] {
        let table = ParameterTable::new(identity);
        let mut rounded_outwards = 0;
        for entry in table.entries() {
            let described = entry.describe();
            let named = described.names.iter().map(|named| f64::from(named.value));
            let mut ends = vec![described.range.minimum, described.range.maximum];
            if !described.names.is_empty() {
                ends = named.collect();
            }
            if entry.id == "SIM_SPEEDUP" {
                ends.push(0.01);
            }
            for end in ends.into_iter().filter(|_| !described.read_only) {
                let sent = end as f32;
                let beyond =
                    f64::from(sent) < described.range.minimum || f64::from(sent) > described.range.maximum;
                rounded_outwards += usize::from(beyond);
                let (_, start) = defaults();
                let mut values = start;
                let what = format!("{} = {end}", entry.id);
                table.set(entry.id, f64::from(sent), &mut values).expect(&what);
                let got = table.find(entry.id).expect("there").value(&values);
                assert_eq!(got.number() as f32, sent, "{what}");
                // As a parameter file has it.
                let mut again = start;
                let number = table.number(entry.id, &got.to_string()).expect(&what);
                table.set(entry.id, number, &mut again).expect(&what);
                assert_eq!(again, values, "{what}");
                // A little further is refused.
                let step = 1e-5 * end.abs().max(1e-5);
                let further = if end == described.range.maximum { end + step } else { end - step };
                let lenient = identity.is_ardupilot()
                    && match entry.source {
                        Source::Kept(..) => true,
                        Source::Conduct(parameter, _) => super::is_open(parameter),
                        _ => false,
                    };
                if described.names.is_empty()
                    && !lenient
                    && !described.whole
                    && end != 0.01
                    && entry.id != "SIM_SPEEDUP"
                {
                    assert!(table.set(entry.id, further, &mut values).is_err(), "{what}: {further}");
                }
            }
        }
        assert!(rounded_outwards > 10, "{identity:?}: this test needs bounds that round outwards");
    }
    let (table, mut values) = defaults();
    assert_eq!(table.set("LIM_TILT", f64::from(1.2_f32), &mut values), Ok(Change::ClosedLoop));
    assert_eq!(values.configuration.limits.tilt_rad, 1.2, "the bound itself");
}

/// They are many: a vehicle more takes no room for them.
#[test]
fn all_vehicles_of_an_identity_share_their_parameters() {
    for identity in [Identity::Px4, Identity::ArduPilot, Identity::Generic] {
        let [one, other] = [(); 2].map(|()| ParameterTable::new(identity));
        assert!(std::ptr::eq(one.entries(), other.entries()));
    }
}
