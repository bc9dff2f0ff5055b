//! `--hil HOST:PORT`: the plant alone, for an external autopilot.

use vehicle::parameters::Speed;

use super::settings::{end_us, first_system_id, vehicle};
use super::{Arguments, fmu};
use crate::failure::Failure;
use crate::hil::HilSettings;
use crate::link::{Endpoint, LinkSpecification};

impl HilSettings {
    /// Resolves arguments that ask for it.
    ///
    /// # Errors
    /// [`Failure`] that names the wrong value, or what means nothing to a plant alone.
    pub fn resolve(arguments: &Arguments, address: &str) -> Result<Self, Failure> {
        let wrong = |name: &str, reason: String| Failure::Value { name: format!("--{name}"), reason };
        for (name, given) in [
            ("vehicles", arguments.vehicles.is_some()),
            ("ports", arguments.ports.is_some()),
            ("formation", arguments.formation.is_some()),
            ("clocks", arguments.clocks.is_some()),
            ("lockstep", arguments.lockstep.is_some()),
            ("link", arguments.link.is_some()),
            ("record", arguments.record.is_some()),
            ("record-size", arguments.record_size.is_some()),
            ("tlog", arguments.tlog.is_some()),
            ("sensors", arguments.sensors.is_some()),
            ("noise", arguments.noise.is_some()),
            ("kalman", arguments.kalman.is_some()),
            ("fault", arguments.fault.is_some()),
            ("mission", arguments.mission.is_some()),
            ("autostart", arguments.autostart.is_some()),
            ("equipment", arguments.equipment.is_some()),
            ("signing-key", arguments.signing_key.is_some()),
            ("accept-signing-setup", arguments.accept_signing_setup.is_some()),
            ("rc-port", arguments.rc_port.is_some()),
            ("view", arguments.view.is_some()),
        ] {
            if given {
                return Err(wrong(
                    name,
                    "does not go with --hil, which only simulates the plant for another program's autopilot"
                        .into(),
                ));
            }
        }
        let speed = arguments.speed.unwrap_or(Speed::Factor(1.0));
        if speed == Speed::Paused {
            return Err(wrong("speed", "0 does not go with --hil: nothing could end the pause".into()));
        }
        let link = format!("tcpin:{address}").parse::<LinkSpecification>();
        let Ok(Endpoint::TcpIn { host, port }) = link.map(|link| link.endpoint) else {
            return Err(wrong("hil", format!("invalid address `{address}`; use [HOST:]PORT")));
        };
        let (vehicle, notes) = vehicle(arguments, 0, 1, arguments.parameters.as_deref())?;
        let fmu = fmu::choice(arguments)?;
        let about_fmu = match &fmu {
            Some(choice) => fmu::check_plant(arguments, choice, &vehicle)?,
            None => Vec::new(),
        };
        Ok(Self {
            fmu,
            host,
            port,
            mount: arguments.hil_mount.unwrap_or_default(),
            vehicle,
            system_id: first_system_id(arguments),
            speed,
            ready_file: arguments.ready_file.clone(),
            no_panel: arguments.no_panel.unwrap_or(false),
            end_us: end_us(arguments),
            notes: notes.into_iter().chain(about_fmu).collect(),
        })
    }
}
