//! What must always hold, seen from the true motion and independent of how the vehicle comes to its own view.

use autopilot::Autopilot;
use nalgebra::Vector3;
use vehicle::{LandedState, Mode, SteeringKind};

use super::figures::Figures;

/// How often it looks, µs.
pub const PERIOD_US: u64 = 50_000;
/// Below this, m, feet are on the ground; above that, m, they are not.
const STANDS_M: f64 = 0.02;
const FLIES_M: f64 = 0.3;
/// A vehicle that stands to stay for so long must know it, µs.
const KNOWS_US: u64 = 2_000_000;
/// A vehicle that has been asked to stay for so long, µs, rests.
const RESTS_US: u64 = 10_000_000;

/// How well a vehicle can stay where it is.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Stays {
    /// It knows where it is, in a calm.
    Calm,
    /// It knows where it is, in gusts.
    InGusts,
    /// It knows what its receiver tells it: 2.1 m of standard deviation on each axis.
    ByInstruments,
}

impl Stays {
    pub fn of(calm: bool, realistic: bool) -> Self {
        match (calm, realistic) {
            (_, true) => Self::ByInstruments,
            (true, false) => Self::Calm,
            (false, false) => Self::InGusts,
        }
    }

    fn within_m(self) -> f64 {
        match self {
            Self::Calm => 0.05,
            Self::InGusts => 0.6,
            Self::ByInstruments => 12.0,
        }
    }
}

#[derive(Default)]
pub struct Watch {
    standing_since_us: Option<u64>,
    /// Where the vehicle is asked to stay, since when, and whether it has rested there.
    stay: Option<(Vector3<f64>, u64, bool)>,
    /// Whether it was armed at the last look.
    armed: bool,
    told: bool,
}

impl Watch {
    pub fn look(&mut self, autopilot: &Autopilot, stays: Stays, figures: &mut Figures) {
        let vehicle = autopilot.vehicle();
        let (system, time_us) = (autopilot.system_id(), vehicle.time_us());
        let outputs = vehicle.truth();
        let height_m = -outputs.position_m.z;
        let mut wrong: Option<String> = None;

        // Landed is on the ground, and flying is not.
        let on_ground = vehicle.landed_state() == LandedState::OnGround;
        if on_ground && height_m > FLIES_M {
            wrong = Some(format!("landed at {height_m:.2} m"));
        }
        let weight_n = vehicle.simulation().configuration().airframe.weight_n();
        // Without thrust, or told to land.
        let unloaded = outputs.thrust_n < 0.5 * weight_n || vehicle.mode() == Mode::Land;
        let stands = height_m < STANDS_M && outputs.velocity_m_s.norm() < 0.05 && unloaded;
        if !stands {
            self.standing_since_us = None;
        } else if time_us - *self.standing_since_us.get_or_insert(time_us) > KNOWS_US && !on_ground {
            wrong = Some(format!("stands, but is {:?}", vehicle.landed_state()));
        }
        // A vehicle without power is on the ground. It leaves a landing in a mode to be armed in; a pilot may choose another
        // one afterwards.
        let was_armed = std::mem::replace(&mut self.armed, vehicle.is_armed());
        if !vehicle.is_armed() {
            if height_m > FLIES_M {
                wrong = Some(format!("disarmed at {height_m:.2} m"));
            }
            if was_armed && matches!(vehicle.mode(), Mode::Land | Mode::Return) {
                wrong = Some(format!("disarmed in {:?}", vehicle.mode()));
            }
        }
        let lean = outputs.attitude_rad.xy().norm();
        if lean > 1.0 || height_m > 130.0 || outputs.position_m.xy().norm() > 400.0 {
            wrong = Some(format!("lost: leans {lean:.2} rad at {:?}", outputs.position_m));
        }
        self.drift(autopilot, stays, figures, &mut wrong);
        match wrong {
            // Once per event.
            Some(what) if !std::mem::replace(&mut self.told, true) => {
                figures.violation(system, time_us, what)
            }
            Some(_) => {}
            None => self.told = false,
        }
    }

    /// A vehicle that holds stays at the place that it began to hold.
    fn drift(
        &mut self,
        autopilot: &Autopilot,
        stays: Stays,
        figures: &mut Figures,
        wrong: &mut Option<String>,
    ) {
        let vehicle = autopilot.vehicle();
        let outputs = vehicle.truth();
        let goal = outputs.setpoint.position_m;
        let holds = vehicle.mode() == Mode::Hold
            && vehicle.steering_kind() == SteeringKind::Position
            && outputs.setpoint.velocity_m_s.norm() < 1e-9;
        // A set-point that is another by more than rounding is a new one.
        self.stay = self.stay.filter(|(place, ..)| holds && (place - goal).norm() < 1e-6);
        if !holds {
            return;
        }
        let (place, since_us, rested) = self.stay.get_or_insert((goal, vehicle.time_us(), false));
        if vehicle.time_us() - *since_us < RESTS_US {
            return;
        }
        figures.rests += u64::from(!std::mem::replace(rested, true));
        let drift_m = (outputs.position_m - *place).norm();
        if stays == Stays::Calm {
            figures.farthest_drift_m = figures.farthest_drift_m.max(drift_m);
        }
        if drift_m > stays.within_m() {
            *wrong = Some(format!("drifted by {drift_m:.3} m from where it holds"));
        }
    }
}
