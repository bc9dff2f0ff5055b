//! What the vehicle carries: what may be asked of it, and one tick of it.

use super::super::notice::{Refusal, Severity};
use super::super::region::RegionOfInterest;
use super::super::tick::TICK_S;
use super::Vehicle;
use crate::equipment::{
    Equipment, FIRST_FREE_CHANNEL, GimbalControl, Grip, Operation, OutputFunction, Surroundings,
};
use crate::plan::Look;
use crate::radio::{Channel, GIMBAL_AXES};

impl Vehicle {
    /// What it carries.
    pub fn equipment(&self) -> &Equipment {
        &self.machines.equipment
    }

    /// Asks something of it.
    ///
    /// # Errors
    /// [`Refusal`] of what there is not, or not now.
    pub fn operate(&mut self, operation: &Operation) -> Result<(), Refusal> {
        if let Operation::Parachute(order) = operation {
            self.order_parachute(*order);
            return Ok(());
        }
        if let Operation::SetServo { channel, .. } | Operation::RepeatServo { channel, .. } = operation {
            self.refuse_functions(*channel)?;
        }
        if let Operation::SetActuators(values) = operation {
            for (channel, _) in (FIRST_FREE_CHANNEL..).zip(values).filter(|(_, value)| value.is_some()) {
                self.refuse_functions(channel)?;
            }
        }
        if matches!(operation, Operation::MoveLandingGear { .. }) && !self.conduct().equipment.landing_gear {
            return Err(Refusal::Failed("no landing gear; LGR_ENABLE = 1 adds one".to_owned()));
        }
        let around = self.surroundings();
        self.machines.equipment.operate(operation, &around)?;
        match operation {
            Operation::Grip { grabs } => {
                let grip = if *grabs { Grip::Grabbing } else { Grip::Releasing };
                self.tell_grip(grip);
            }
            Operation::MoveLandingGear { down } => {
                let what = if *down { "DEPLOY" } else { "RETRACT" };
                self.decided.say(Severity::Info, format!("LandingGear: {what}"));
            }
            _ => {}
        }
        Ok(())
    }

    /// Whether it still looks at something that it was told to look at.
    pub fn looks_at(&self, look: &Look) -> bool {
        let (here_m, home_z_m) = (self.outputs().position_m, self.decided.home().position_m.z);
        self.decided.region() == Some(RegionOfInterest::of(look, &here_m, home_z_m))
    }

    /// Lets clients point the gimbal.
    pub fn give_gimbal_control(&mut self, control: GimbalControl) {
        self.machines.equipment.give_gimbal_control(control);
    }

    /// One tick of it, unless nothing happens.
    pub(super) fn step_equipment(&mut self) {
        let closes_after_s = self.conduct().equipment.gripper_closes_after_s;
        if self.machines.equipment.rests(self.decided.region().is_some(), closes_after_s) {
            return;
        }
        let around = self.surroundings();
        match self.machines.equipment.step(&around, closes_after_s, TICK_S) {
            Ok(None) => {}
            Ok(Some(grip)) => self.tell_grip(grip),
            Err(refusal) => self.decided.say(Severity::Warning, refusal.to_string()),
        }
    }

    fn tell_grip(&mut self, grip: Grip) {
        self.decided.say(Severity::Info, format!("Gripper load {}", grip.word()));
    }

    fn surroundings(&self) -> Surroundings {
        let (outputs, region) = (self.outputs(), self.decided.region());
        Surroundings {
            time_us: outputs.time_us,
            position_m: outputs.position_m,
            home_m: self.decided.home().position_m,
            attitude_rad: outputs.attitude_rad,
            region_m: match region {
                Some(RegionOfInterest::Place(place_m)) => Some(place_m),
                _ => None,
            },
            looks: region.is_some(),
            mount: self.conduct().equipment.mount,
            deflections: self.gimbal_deflections(),
            radio_is_lost: self.pilot().is_doubted,
        }
    }

    /// Deflections of the pilot's channels for roll, pitch and yaw of the gimbal, within ±1, while they point it. Without the radio they
    /// stay where they were.
    fn gimbal_deflections(&self) -> [f64; 3] {
        if !self.equipment().gimbal().is_pointed_by_radio() {
            return [0.0; 3];
        }
        let channels = &self.conduct().radio.channels;
        let deflection = |option: u32| {
            let is_for_it = |channel: &Channel| channel.option == f64::from(option);
            let (index, channel) = channels.iter().enumerate().find(|(_, channel)| is_for_it(channel))?;
            let pulse_us = self.pilot().believed?.get(index).copied().filter(|pulse_us| *pulse_us > 0)?;
            Some(channel.deflection(pulse_us))
        };
        GIMBAL_AXES.map(|option| deflection(option).unwrap_or_default())
    }

    /// Refuses commands to an output that follows something else.
    fn refuse_functions(&self, channel: u8) -> Result<(), Refusal> {
        let number = usize::from(channel);
        let output = self.conduct().equipment.output(number);
        let taken = output.is_some_and(|output| output.follows(number) != OutputFunction::Command);
        if taken {
            return Err(Refusal::Failed(format!(
                "Servo {channel} follows a function; set SERVO{channel}_FUNCTION to 0 first"
            )));
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::Operation;
    use crate::identity::Identity;
    use crate::vehicle::{Refusal, Vehicle, VehicleSettings};

    #[test]
    fn an_output_with_a_function_takes_no_commands() {
        let mut settings = VehicleSettings::new(Identity::ArduPilot);
        // Output 6 follows the gripper.
        settings.conduct.equipment.outputs[1].function = 28.0;
        let mut vehicle = Vehicle::new(&settings).expect("valid settings");
        let refused = "Servo 6 follows a function; set SERVO6_FUNCTION to 0 first".to_owned();
        let both = Operation::SetActuators([Some(-1.0), Some(1.0), None, None]);
        assert_eq!(vehicle.operate(&both), Err(Refusal::Failed(refused)));
        assert_eq!(vehicle.equipment().servos().pulse_us(5), 0, "nothing of it is done");
        assert_eq!(vehicle.operate(&Operation::SetActuators([Some(-1.0), None, Some(1.0), None])), Ok(()));
        assert_eq!([5, 7].map(|channel| vehicle.equipment().servos().pulse_us(channel)), [1000, 2000]);
    }
}
