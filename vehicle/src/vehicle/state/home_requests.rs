//! Requests that move home.

use nalgebra::Vector3;

use super::super::notice::Refusal;
use super::Vehicle;

impl Vehicle {
    /// Moves home. PX4 goes on to where the altitude of the present leg is then, ArduPilot takes it for the next one.
    ///
    /// # Errors
    /// [`Refusal`] too far away.
    pub fn set_home(&mut self, position_m: Vector3<f64>, yaw_rad: Option<f64>) -> Result<(), Refusal> {
        let before_m = self.decided.home().position_m.z;
        self.consult(|_, situation, proposal| proposal.set_home(situation, position_m, yaw_rad))?;
        if !self.identity().is_ardupilot() && self.decided.home().position_m.z != before_m {
            self.consult(|parts, situation, proposal| parts.mission.heed_home(situation, proposal));
        }
        Ok(())
    }
}
