//! What has been decided: the state that all machines share. They ask for changes of it, and one place makes them.

use super::home::Home;
use super::notice::{Notice, Severity};
use super::region::RegionOfInterest;
use super::steering::Steering;
use crate::mode::Mode;

/// The shared state.
#[derive(Clone, Debug, PartialEq)]
pub struct Decided {
    armed: bool,
    /// Whether the last flight was ended in the air; until it is armed again.
    terminated: bool,
    mode: Mode,
    steering: Steering,
    home: Home,
    region: Option<RegionOfInterest>,
    notices: Vec<Notice>,
}

impl Decided {
    /// A disarmed vehicle at home.
    pub fn new(mode: Mode, home: Home) -> Self {
        Self {
            armed: false,
            terminated: false,
            mode,
            steering: Steering::Idle { yaw_rad: home.yaw_rad },
            home,
            region: None,
            notices: Vec::new(),
        }
    }

    /// Whether the rotors may turn.
    pub fn is_armed(&self) -> bool {
        self.armed
    }

    /// Whether the last flight was ended in the air.
    pub fn is_terminated(&self) -> bool {
        self.terminated
    }

    /// The mode.
    pub fn mode(&self) -> Mode {
        self.mode
    }

    /// How it is steered.
    pub fn steering(&self) -> &Steering {
        &self.steering
    }

    /// Home.
    pub fn home(&self) -> &Home {
        &self.home
    }

    /// What is looked at.
    pub fn region(&self) -> Option<RegionOfInterest> {
        self.region
    }

    /// The rotors may turn.
    pub fn arm(&mut self) {
        (self.armed, self.terminated) = (true, false);
    }

    /// The rotors stop.
    pub fn disarm(&mut self) {
        self.armed = false;
    }

    /// The flight is ended in the air.
    pub fn terminate(&mut self) {
        self.terminated = true;
    }

    /// Changes the mode, and nothing else.
    pub fn switch_to(&mut self, mode: Mode) {
        self.mode = mode;
    }

    /// Steers like this.
    pub fn steer(&mut self, steering: Steering) {
        self.steering = steering;
    }

    /// The steering, for the closed loop that flies it: a reference that moves goes on with each tick.
    pub fn steering_to_fly(&mut self) -> &mut Steering {
        &mut self.steering
    }

    /// Moves home.
    pub fn move_home(&mut self, home: Home) {
        self.home = home;
    }

    /// Looks at something else, or at nothing.
    pub fn look_at(&mut self, region: Option<RegionOfInterest>) {
        self.region = region;
    }

    /// Tells the pilot.
    pub fn say(&mut self, severity: Severity, text: impl Into<String>) {
        self.notices.push(Notice { severity, text: text.into() });
    }

    /// Passes a line on to the pilot.
    pub fn pass_on(&mut self, notice: Notice) {
        self.notices.push(notice);
    }

    /// Notices since the last call.
    pub fn take_notices(&mut self) -> Vec<Notice> {
        std::mem::take(&mut self.notices)
    }
}
