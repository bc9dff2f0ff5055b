//! Writing parameter files.

use super::FileFormat;
use super::line::AUTOPILOT;
use crate::parameters::{ParameterTable, ParameterValues, Value};

/// MAV_PARAM_TYPE of whole numbers.
const INT32: u8 = 6;
/// MAV_PARAM_TYPE of other numbers.
const REAL32: u8 = 9;

/// The text of a file that holds every parameter.
pub fn render(format: FileFormat, table: &ParameterTable, values: &ParameterValues) -> String {
    let system = values.system_id;
    let mut text = match format {
        FileFormat::Plain => "# Parameters of lmpc-sitl: name and value\n".to_owned(),
        FileFormat::QGroundControl => format!(
            "# Onboard parameters for Vehicle {system}\n#\n# Stack: lmpc-sitl\n#\n# Vehicle-Id Component-Id Name Value Type\n"
        ),
    };
    for (index, entry) in table.entries().iter().enumerate().filter(|(_, entry)| entry.is_kept()) {
        let Some(value) = table.value(index, values) else { continue };
        let id = entry.id;
        match format {
            FileFormat::Plain => text.push_str(&format!("{id} {value}\n")),
            FileFormat::QGroundControl => {
                let kind = match value {
                    Value::Integer(_) => INT32,
                    Value::Real(_) => REAL32,
                };
                text.push_str(&format!("{system}\t{AUTOPILOT}\t{id}\t{value}\t{kind}\n"));
            }
        }
    }
    text
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use quadrotor::{Configuration, ControllerKind};

    use super::{FileFormat, render};
    use crate::identity::Identity;
    use crate::parameters::{ParameterTable, ParameterValues, Speed, Statistics, parse};
    use crate::vehicle::Conduct;

    fn values(system_id: u8) -> ParameterValues {
        let (configuration, conduct) = (Configuration::default(), Conduct::new(false));
        ParameterValues {
            configuration,
            conduct,
            system_id,
            speed: Speed::Factor(1.0),
            statistics: Statistics::default(),
        }
    }

    /// As QGroundControl saves them from system 3: every parameter, floats with 18 digits, those of a camera among them.
    #[test]
    fn files_of_ground_stations_are_read() {
        let table = ParameterTable::new(Identity::Px4);
        let text = "\u{feff}# Onboard parameters for Vehicle 3\r\n#\r\n# Stack: PX4 Pro\r\n# Vehicle-Id Component-Id Name Value Type\r\n\
                    3\t1\tFRAME_MASS\t0.800000011920928955\t9\r\n3\t1\tCTRL_KIND\t3\t6\r\n3\t1\tMAV_SYS_ID\t3\t6\r\n\
                    3\t1\tSIM_SPEEDUP\t5.000000000000000000\t9\r\n3\t100\tCAM_MODE\t1\t6\r\n3\t1\tLIM_TILT\t1.20000004768371582\t9\r\n";
        let mut read = values(1);
        assert_eq!(parse(text, &table, &mut read), Ok(vec!["FRAME_MASS", "CTRL_KIND", "LIM_TILT"]));
        assert_eq!(read.configuration.airframe.mass_kg as f32, 0.8);
        assert_eq!(read.configuration.controllers.kind, ControllerKind::Dlqr);
        assert_eq!(read.configuration.limits.tilt_rad, 1.2);
        assert_eq!((read.system_id, read.speed), (1, Speed::Factor(1.0)));
        // By any name, and as people write.
        let text = "airframe.mass = 0.9 # kg\ncontroller.kind = dlqr\nLIM_SPEED_H,4\nNAV_DLL_ACT = hold\nC_GOVERNOR off\n";
        let mut read = values(1);
        let named = ["FRAME_MASS", "CTRL_KIND", "LIM_SPEED_HORIZ", "NAV_DLL_ACT", "CTRL_GOVERNOR"];
        assert_eq!(parse(text, &table, &mut read), Ok(named.to_vec()));
        assert_eq!(read.configuration.limits.speed_horizontal_m_s, 4.0);
        assert!(!read.configuration.controllers.governor);
    }

    #[test]
    fn what_is_wrong_is_told_with_its_line() {
        let table = ParameterTable::new(Identity::Px4);
        for (text, expected) in [
            ("# a\nFRAME_MASS\n", "line 2: expected `NAME VALUE`, got `FRAME_MASS`"),
            ("airframe.mas 1", "line 1: unknown parameter airframe.mas; did you mean airframe.mass?"),
            (
                "\ncontroller.kind = pid",
                "line 2: controller.kind = pid; allowed 1 (lmpc), 2 (ssmpc), 3 (dlqr)",
            ),
            ("1\t1\tLIM_TILT\t45\t9", "line 1: LIM_TILT = 45 rad; allowed 0.05–1.2 rad (3°–69°)"),
        ] {
            assert_eq!(parse(text, &table, &mut values(1)).expect_err(text).to_string(), expected);
        }
    }

    #[test]
    fn what_is_written_is_in_the_tools_form_and_read_again() {
        let table = ParameterTable::new(Identity::Px4);
        let mut changed = values(3);
        parse("airframe.mass 0.9\nNAV_DLL_ACT hold", &table, &mut changed).expect("read");
        for (path, mass, action) in [
            ("a/vehicle.params", "\n3\t1\tFRAME_MASS\t0.9\t9\n", "\n3\t1\tNAV_DLL_ACT\t1\t6\n"),
            ("vehicle.parm", "\nFRAME_MASS 0.9\n", "\nNAV_DLL_ACT 1\n"),
            ("vehicle", "\nFRAME_MASS 0.9\n", "\nNAV_DLL_ACT 1\n"),
        ] {
            let text = render(FileFormat::of(Path::new(path)), &table, &changed);
            assert!(text.contains(mass) && text.contains(action), "{path}: {text}");
            let mut again = values(3);
            let read = parse(&text, &table, &mut again).expect("read");
            assert_eq!(read.len(), table.entries().iter().filter(|entry| entry.is_kept()).count());
            assert_eq!(again, changed, "{path}");
            // Former names are not written.
            let former = table.entries().iter().filter_map(|entry| entry.former);
            for former in former {
                assert!(!text.split_whitespace().any(|word| word == former), "{former}");
            }
        }
    }
}
