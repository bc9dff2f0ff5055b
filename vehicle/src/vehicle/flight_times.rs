//! When the vehicle was armed, took off and landed.

use super::situation::Situation;

/// Times of the present or the last flight since the boot, µs; `None`: it has not happened yet.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub struct FlightTimes {
    /// When it was armed.
    pub armed_us: Option<u64>,
    /// When it took off.
    pub took_off_us: Option<u64>,
    /// When it came back to the ground; `None` in the air.
    pub landed_us: Option<u64>,
    was_armed: bool,
    flew: bool,
}

impl FlightTimes {
    /// One tick.
    pub fn watch(&mut self, situation: &Situation) {
        let (armed, flies) = (situation.armed, !situation.landed);
        if armed && !self.was_armed {
            *self = Self { armed_us: Some(situation.time_us), flew: self.flew, ..Self::default() };
        }
        if armed && flies && !self.flew {
            (self.took_off_us, self.landed_us) = (Some(situation.time_us), None);
        } else if !flies && self.flew && self.took_off_us.is_some() {
            self.landed_us = Some(situation.time_us);
        }
        (self.was_armed, self.flew) = (armed, flies);
    }
}

#[cfg(test)]
mod tests {
    use super::FlightTimes;
    use crate::vehicle::scene::Scene;

    #[test]
    fn a_flight_has_its_times_until_the_next_one() {
        let mut scene = Scene::on_the_ground();
        scene.armed = false;
        let mut times = FlightTimes::default();
        let mut step = |armed: bool, landed: bool| {
            scene.wait_us(1_000);
            (scene.armed, scene.landed) = (armed, landed);
            times.watch(&scene.situation());
            (times, scene.outputs.time_us)
        };
        assert_eq!(step(false, true).0, FlightTimes::default());
        let (_, armed_us) = step(true, true);
        let (_, took_off_us) = step(true, false);
        step(true, false);
        let (landed, landed_us) = step(true, true);
        assert_eq!(
            (landed.armed_us, landed.took_off_us, landed.landed_us),
            (Some(armed_us), Some(took_off_us), Some(landed_us))
        );
        assert_eq!(step(false, true).0.landed_us, Some(landed_us));
        let (again, again_us) = step(true, true);
        assert_eq!((again.armed_us, again.took_off_us, again.landed_us), (Some(again_us), None, None));
    }
}
