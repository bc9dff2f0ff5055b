//! PX4's speeds that are bound to one another: the largest ones, those of automatic flight, and those that set several at once.

use super::ParameterValues;
use crate::vehicle::{Conduct, LEAST_SPEED_M_S};

/// Largest speed of a landing near the ground, m/s.
const FASTEST_LANDING_M_S: f64 = 3.0;
/// What PX4 makes of the overall vertical speed: downwards, of a takeoff, of a landing.
const SHARE_DOWN: f64 = 0.75;
const SHARE_TAKEOFF: f64 = 0.6;
const SHARE_LANDING: f64 = 0.5;

/// One of them.
#[derive(Clone, Copy, Debug)]
pub struct SpeedParameter {
    /// Its name.
    pub id: &'static str,
    /// Smallest value, m/s.
    pub minimum: f64,
    /// Largest value, m/s.
    pub maximum: f64,
    /// What it is.
    pub text: &'static str,
    /// Which one.
    kind: Kind,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Kind {
    /// The largest in all modes: horizontally, up, down.
    Most(usize),
    /// All horizontal ones.
    AllHorizontal,
    /// All vertical ones.
    AllVertical,
}

/// All of them.
#[rustfmt::skip] // One line per parameter reads as the table that it is.
pub static SPEED_PARAMETERS: &[SpeedParameter] = &[
    SpeedParameter { id: "MPC_XY_VEL_MAX", minimum: 0.0, maximum: 20.0, kind: Kind::Most(0), text: "Largest horizontal speed in all modes; that of MPC_XY_CRUISE until it is set" },
    SpeedParameter { id: "MPC_Z_VEL_MAX_UP", minimum: 0.0, maximum: 8.0, kind: Kind::Most(1), text: "Largest climb rate in all modes; that of MPC_Z_V_AUTO_UP until it is set" },
    SpeedParameter { id: "MPC_Z_VEL_MAX_DN", minimum: 0.0, maximum: 8.0, kind: Kind::Most(2), text: "Largest sink rate in all modes; that of MPC_Z_V_AUTO_DN until it is set" },
    SpeedParameter { id: "MPC_XY_VEL_ALL", minimum: -20.0, maximum: 20.0, kind: Kind::AllHorizontal, text: "Sets MPC_XY_CRUISE, MPC_XY_VEL_MAX and MPC_VEL_MANUAL; negative leaves them as they are" },
    SpeedParameter { id: "MPC_Z_VEL_ALL", minimum: -3.0, maximum: 8.0, kind: Kind::AllVertical, text: "Sets MPC_Z_VEL_MAX_UP, MPC_Z_VEL_MAX_DN, MPC_TKO_SPEED and MPC_LAND_SPEED to 1, 0.75, 0.6 and 0.5 times itself; negative leaves them as they are" },
];

impl SpeedParameter {
    /// Its value, m/s.
    pub(super) fn get(&self, values: &ParameterValues) -> f64 {
        let speeds = &values.conduct.speeds;
        match self.kind {
            Kind::Most(axis) => speeds.most_m_s[axis].unwrap_or(of_automatic_flight(values)[axis]),
            Kind::AllHorizontal => speeds.all_horizontal_m_s,
            Kind::AllVertical => speeds.all_vertical_m_s,
        }
    }

    /// Sets it to a value within its range, m/s.
    pub(super) fn set(&self, value_m_s: f64, conduct: &mut Conduct) {
        let speeds = &mut conduct.speeds;
        match self.kind {
            Kind::Most(axis) => speeds.most_m_s[axis] = Some(value_m_s),
            Kind::AllHorizontal => speeds.all_horizontal_m_s = value_m_s,
            Kind::AllVertical => speeds.all_vertical_m_s = value_m_s,
        }
    }
}

fn of_automatic_flight(values: &ParameterValues) -> [f64; 3] {
    let limits = &values.configuration.limits;
    [limits.speed_horizontal_m_s, limits.speed_up_m_s, limits.speed_down_m_s]
}

/// Brings all speeds into agreement after one has been set, as PX4 does: the overall ones set theirs, and no speed is above the largest
/// one.
pub(super) fn settle(values: &mut ParameterValues) {
    let (conduct, limits) = (&mut values.conduct, &mut values.configuration.limits);
    let [horizontal, vertical] = [conduct.speeds.all_horizontal_m_s, conduct.speeds.all_vertical_m_s];
    if horizontal >= 0.0 {
        conduct.speeds.most_m_s[0] = Some(horizontal);
        conduct.stick_speed_m_s = horizontal.max(LEAST_SPEED_M_S);
        limits.speed_horizontal_m_s = horizontal.max(LEAST_SPEED_M_S);
    }
    if vertical >= 0.0 {
        conduct.speeds.most_m_s[1] = Some(vertical);
        conduct.speeds.most_m_s[2] = Some(SHARE_DOWN * vertical);
        conduct.speeds.takeoff_m_s = SHARE_TAKEOFF * vertical;
        conduct.land_speed_m_s = (SHARE_LANDING * vertical).clamp(LEAST_SPEED_M_S, FASTEST_LANDING_M_S);
    }
    let [horizontal, up, down] =
        conduct.speeds.most_m_s.map(|most_m_s| most_m_s.map(|most| most.max(LEAST_SPEED_M_S)));
    let bound = |speed_m_s: &mut f64, most_m_s: Option<f64>| {
        *speed_m_s = most_m_s.map_or(*speed_m_s, |most_m_s| speed_m_s.min(most_m_s));
    };
    bound(&mut limits.speed_horizontal_m_s, horizontal);
    bound(&mut conduct.stick_speed_m_s, horizontal);
    bound(&mut limits.speed_up_m_s, up);
    bound(&mut limits.speed_down_m_s, down);
    bound(&mut conduct.land_speed_m_s, down);
}

#[cfg(test)]
mod tests {
    use quadrotor::Configuration;

    use crate::identity::Identity;
    use crate::parameters::{ParameterTable, ParameterValues, Speed, Statistics};
    use crate::vehicle::Conduct;

    /// Sets parameters in turn, and reads others.
    fn check(set: &[(&str, f64)], told: &[(&str, f64)]) {
        let table = ParameterTable::new(Identity::Px4);
        let mut values = ParameterValues {
            configuration: Configuration::default(),
            conduct: Conduct::new(false),
            system_id: 1,
            speed: Speed::Factor(1.0),
            statistics: Statistics::default(),
        };
        for (name, value) in set {
            table.set(name, *value, &mut values).expect(name);
        }
        for (name, expected) in told {
            let shown = table.find(name).expect(name).value(&values).number();
            assert!((shown - expected).abs() < 1e-5, "{set:?}: {name} = {shown}, expected {expected}");
        }
    }

    /// As PX4's position controller brings its parameters into agreement.
    #[test]
    fn no_speed_is_above_the_largest_one() {
        check(&[], &[("MPC_XY_VEL_MAX", 8.0), ("MPC_TKO_SPEED", 1.5), ("MPC_XY_VEL_ALL", -10.0)]);
        check(&[("MPC_XY_CRUISE", 10.0)], &[("MPC_XY_VEL_MAX", 10.0)]);
        let lowered = [("MPC_XY_CRUISE", 4.0), ("MPC_VEL_MANUAL", 4.0), ("LIM_SPEED_HORIZ", 4.0)];
        check(&[("MPC_XY_VEL_MAX", 4.0)], &lowered);
        check(&[("MPC_XY_VEL_MAX", 12.0)], &[("MPC_XY_CRUISE", 8.0), ("MPC_XY_VEL_MAX", 12.0)]);
        check(&[("MPC_XY_VEL_MAX", 4.0), ("MPC_XY_CRUISE", 6.0)], &[("MPC_XY_CRUISE", 4.0)]);
        check(
            &[("MPC_Z_VEL_MAX_UP", 2.0), ("MPC_Z_VEL_MAX_DN", 0.5)],
            &[("MPC_Z_V_AUTO_UP", 2.0), ("MPC_Z_V_AUTO_DN", 0.5), ("MPC_LAND_SPEED", 0.5)],
        );
    }

    #[test]
    fn an_overall_speed_sets_the_others() {
        let horizontal = [("MPC_XY_CRUISE", 3.0), ("MPC_XY_VEL_MAX", 3.0), ("MPC_VEL_MANUAL", 3.0)];
        check(&[("MPC_XY_VEL_ALL", 3.0)], &horizontal);
        // It does so again when one of them is set.
        check(&[("MPC_XY_VEL_ALL", 3.0), ("MPC_XY_CRUISE", 5.0)], &horizontal);
        check(
            &[("MPC_XY_VEL_ALL", 3.0), ("MPC_XY_VEL_ALL", -1.0), ("MPC_XY_VEL_MAX", 6.0)],
            &[("MPC_XY_CRUISE", 3.0), ("MPC_XY_VEL_MAX", 6.0)],
        );
        check(
            &[("MPC_Z_VEL_ALL", 2.0)],
            &[
                ("MPC_Z_VEL_MAX_UP", 2.0),
                ("MPC_Z_VEL_MAX_DN", 1.5),
                ("MPC_TKO_SPEED", 1.2),
                ("MPC_LAND_SPEED", 1.0),
            ],
        );
    }
}
