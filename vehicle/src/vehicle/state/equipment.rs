//! What the vehicle carries: what may be asked of it, and one tick of it.

use super::super::notice::{Refusal, Severity};
use super::super::region::RegionOfInterest;
use super::super::tick::TICK_S;
use super::Vehicle;
use crate::equipment::{Equipment, GimbalControl, Operation, Surroundings};
use crate::plan::Look;

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
        let around = self.surroundings();
        self.machines.equipment.operate(operation, &around)?;
        if let Operation::Grip { grabs } = operation {
            let what = if *grabs { "grabbing" } else { "releasing" };
            self.decided.say(Severity::Info, format!("Gripper load {what}"));
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
        if self.machines.equipment.rests(self.decided.region().is_some()) {
            return;
        }
        let around = self.surroundings();
        match self.machines.equipment.step(&around, TICK_S) {
            Ok(None) => {}
            Ok(Some(grabbed)) => {
                let what = if grabbed { "grabbed" } else { "released" };
                self.decided.say(Severity::Info, format!("Gripper load {what}"));
            }
            Err(refusal) => self.decided.say(Severity::Warning, refusal.to_string()),
        }
    }

    fn surroundings(&self) -> Surroundings {
        let (outputs, region) = (self.outputs(), self.decided.region());
        Surroundings {
            time_us: outputs.time_us,
            position_m: outputs.position_m,
            home_z_m: self.decided.home().position_m.z,
            attitude_rad: outputs.attitude_rad,
            region_m: match region {
                Some(RegionOfInterest::Place(place_m)) => Some(place_m),
                _ => None,
            },
            looks: region.is_some(),
        }
    }
}
