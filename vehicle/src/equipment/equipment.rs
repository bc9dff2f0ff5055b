//! All of the equipment together.

use nalgebra::Vector3;

use super::camera::Camera;
use super::controller::GimbalControl;
use super::gimbal::Gimbal;
use super::gripper::{Grip, Gripper};
use super::mount::MountSettings;
use super::operation::{Operation, Pointing};
use super::parachute::Parachute;
use super::relays::Relays;
use super::servos::{FIRST_FREE_CHANNEL, Servos};
use super::surroundings::Surroundings;
use crate::Refusal;

/// Pulse in the middle of a servo's range, and half of the range, µs.
const MIDDLE_US: f64 = 1500.0;
const HALF_US: f64 = 500.0;

/// The equipment.
#[derive(Clone, Debug, PartialEq, Default)]
pub struct Equipment {
    servos: Servos,
    relays: Relays,
    gripper: Gripper,
    /// Where the landing gear is; `None`: it hangs loose.
    landing_gear_is_down: Option<bool>,
    parachute: Parachute,
    camera: Camera,
    gimbal: Gimbal,
    gimbal_control: GimbalControl,
}

impl Equipment {
    /// With a gimbal that is mounted so.
    pub fn new(mount: &MountSettings) -> Self {
        Self { gimbal: Gimbal::mounted(mount), ..Self::default() }
    }

    /// The servo outputs.
    pub fn servos(&self) -> &Servos {
        &self.servos
    }

    /// The relays.
    pub fn relays(&self) -> &Relays {
        &self.relays
    }

    /// The gripper.
    pub fn gripper(&self) -> &Gripper {
        &self.gripper
    }

    /// Whether the landing gear is down; `None`: it hangs loose, as nobody has moved it.
    pub fn landing_gear_is_down(&self) -> Option<bool> {
        self.landing_gear_is_down
    }

    /// The parachute.
    pub fn parachute(&self) -> &Parachute {
        &self.parachute
    }

    /// The parachute, to be released or opened.
    pub fn parachute_mut(&mut self) -> &mut Parachute {
        &mut self.parachute
    }

    /// The camera.
    pub fn camera(&self) -> &Camera {
        &self.camera
    }

    /// The gimbal.
    pub fn gimbal(&self) -> &Gimbal {
        &self.gimbal
    }

    /// Who points the gimbal.
    pub fn gimbal_control(&self) -> GimbalControl {
        self.gimbal_control
    }

    /// Lets others point the gimbal.
    pub fn give_gimbal_control(&mut self, control: GimbalControl) {
        self.gimbal_control = control;
    }

    /// The gimbal looks where the vehicle looks, from now on.
    pub fn track(&mut self) {
        self.gimbal.track();
    }

    /// Whether nothing happens by itself while the vehicle looks at something, or at nothing.
    pub fn rests(&self, looks: bool, gripper_closes_after_s: f64) -> bool {
        self.camera.rests()
            && self.gimbal.rests(looks)
            && self.servos.rest()
            && self.relays.rest()
            && !self.gripper.acts(gripper_closes_after_s)
    }

    /// Does what is asked.
    ///
    /// # Errors
    /// [`Refusal`] of what there is not, or not now.
    pub fn operate(&mut self, operation: &Operation, around: &Surroundings) -> Result<(), Refusal> {
        let now_us = around.time_us;
        self.gimbal.mount(&around.mount);
        match *operation {
            Operation::SetServo { channel, pulse_us } => self.servos.set(channel, pulse_us),
            Operation::RepeatServo { channel, pulse_us, cycles, period_s } => {
                self.servos.repeat(channel, pulse_us, cycles, period_s, now_us)
            }
            Operation::SetActuators(values) => self.set_actuators(&values),
            Operation::SetRelay { relay, to } => self.relays.set(relay, to),
            Operation::RepeatRelay { relay, cycles, period_s } => {
                self.relays.repeat(relay, cycles, period_s, now_us)
            }
            Operation::Grip { grabs } => {
                self.gripper.command(grabs, now_us);
                Ok(())
            }
            Operation::MoveLandingGear { down } => {
                self.landing_gear_is_down = Some(down);
                Ok(())
            }
            Operation::Point(pointing) => {
                self.gimbal.point(&pointing, around.attitude_rad.z);
                Ok(())
            }
            Operation::CentreGimbal
            | Operation::RetractGimbal
            | Operation::SetGimbalMode(_)
            | Operation::HoldGimbal
            | Operation::LockGimbal
            | Operation::LookAt(_)
            | Operation::UnlockGimbal { .. } => {
                self.operate_gimbal(operation, around);
                Ok(())
            }
            of_camera => self.operate_camera(&of_camera, around),
        }
    }

    fn operate_gimbal(&mut self, operation: &Operation, around: &Surroundings) {
        match *operation {
            Operation::CentreGimbal => self.gimbal.centre(),
            Operation::RetractGimbal => self.gimbal.retract(),
            Operation::SetGimbalMode(mode) => self.gimbal.set_mode(mode),
            Operation::HoldGimbal => self.gimbal.stay(),
            Operation::LockGimbal => self.gimbal.lock_on(around),
            Operation::UnlockGimbal { forget } => self.gimbal.look_off(forget),
            Operation::LookAt(place_m) => self.gimbal.look_at(place_m),
            _ => {}
        }
    }

    fn set_actuators(&mut self, values: &[Option<f64>]) -> Result<(), Refusal> {
        for (channel, value) in (FIRST_FREE_CHANNEL..).zip(values) {
            if let Some(value) = value {
                self.servos.set(channel, (MIDDLE_US + HALF_US * value.clamp(-1.0, 1.0)).round() as u16)?;
            }
        }
        Ok(())
    }

    fn operate_camera(&mut self, operation: &Operation, around: &Surroundings) -> Result<(), Refusal> {
        let now_us = around.time_us;
        match *operation {
            Operation::Capture { interval_s, count } => {
                self.camera.start_capture(interval_s, count, now_us)?
            }
            Operation::StopCapture => self.camera.stop_capture(),
            Operation::Shoot => self.shoot(around)?,
            Operation::TriggerByDistance { distance_m, at_once, oblique } => {
                // Without an image at once the way is counted from here.
                let from_m = (!at_once).then_some(&around.position_m);
                self.camera.trigger_mut().by_distance(distance_m, from_m, oblique);
                self.swing();
            }
            Operation::TriggerByTime { interval_s } => {
                self.camera.trigger_mut().by_interval(interval_s, now_us);
            }
            Operation::ControlTrigger { enabled, paused, reset } => {
                self.camera.trigger_mut().control(enabled, paused);
                if reset {
                    self.camera.reset_count();
                }
            }
            Operation::Record(on) => self.camera.record(on, now_us)?,
            Operation::SetCameraMode(mode) => self.camera.set_mode(mode),
            Operation::Zoom(drive) => self.camera.zoom(drive),
            Operation::Focus(drive) => self.camera.focus(drive),
            Operation::ResetCamera => self.camera.reset(),
            Operation::Format { reset_count } => self.camera.format(reset_count)?,
            _ => {}
        }
        Ok(())
    }

    /// Moves on by a time, s. Returns what is worth telling: what the gripper has done, and why there is no image.
    ///
    /// # Errors
    /// [`Refusal`] of an image that was due.
    pub fn step(
        &mut self,
        around: &Surroundings,
        gripper_closes_after_s: f64,
        dt_s: f64,
    ) -> Result<Option<Grip>, Refusal> {
        self.servos.step(around.time_us);
        self.relays.step(around.time_us);
        self.gimbal.step(around, dt_s);
        let gripped = self.gripper.step(around.time_us, gripper_closes_after_s);
        for _ in 0..self.camera.step(around, dt_s) {
            if let Err(refusal) = self.shoot(around) {
                self.camera.stop_capture();
                self.camera.trigger_mut().control(Some(false), None);
                return Err(refusal);
            }
            self.swing();
        }
        Ok(gripped)
    }

    fn shoot(&mut self, around: &Surroundings) -> Result<(), Refusal> {
        let [roll, pitch, _] = self.gimbal.angles_rad().data.0[0];
        let yaw = self.gimbal.yaw_in(true, around.attitude_rad.z);
        self.camera.shoot(around, Vector3::new(roll, pitch, yaw))
    }

    /// Swings the camera to the position of the next image, where a survey is oblique.
    fn swing(&mut self) {
        let Some(oblique) = self.camera.oblique() else { return };
        let to = Pointing {
            roll_rad: Some(oblique.roll_at(self.camera.triggers())),
            pitch_rad: Some(oblique.pitch_rad),
            yaw_rad: Some(0.0),
            ..Pointing::default()
        };
        self.gimbal.point(&to, 0.0);
    }
}
