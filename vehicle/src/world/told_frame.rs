//! The local frame in which clients count.

use nalgebra::Vector3;

use super::{Geodetic, LocalFrame};

/// The local frame of the flight, unless a client has moved its origin. The flight itself stays in the frame that it began in.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ToldFrame {
    flown: LocalFrame,
    moved: Option<LocalFrame>,
}

impl ToldFrame {
    /// That of the flight.
    pub fn new(flown: LocalFrame) -> Self {
        Self { flown, moved: None }
    }

    /// Moves the origin.
    pub fn move_to(&mut self, origin: Geodetic) {
        self.moved = Some(LocalFrame::new(origin));
    }

    /// The origin.
    pub fn origin(&self) -> Geodetic {
        self.moved.unwrap_or(self.flown).origin()
    }

    /// A position of the flight as clients count it, NED, m.
    pub fn told_m(&self, flown_m: &Vector3<f64>) -> Vector3<f64> {
        self.moved.map_or(*flown_m, |moved| moved.to_local_m(&self.flown.to_geodetic(flown_m)))
    }

    /// What a client means by a position, NED, m.
    pub fn meant_m(&self, told_m: &Vector3<f64>) -> Vector3<f64> {
        self.moved.map_or(*told_m, |moved| self.flown.to_local_m(&moved.to_geodetic(told_m)))
    }
}

#[cfg(test)]
mod tests {
    use super::{Geodetic, LocalFrame, ToldFrame};
    use nalgebra::Vector3;

    #[test]
    fn a_moved_origin_moves_what_is_told_and_no_place() {
        let mut frame = ToldFrame::new(LocalFrame::new(Geodetic::default()));
        let place_m = Vector3::new(3.0, -4.0, -5.0);
        assert_eq!(frame.told_m(&place_m), place_m);
        assert_eq!(frame.meant_m(&place_m), place_m);
        // A degree of latitude is 111 km: about 111 m north, and 12 m up.
        let start = Geodetic::default();
        let origin = Geodetic {
            latitude_deg: start.latitude_deg + 0.001,
            altitude_m: start.altitude_m + 12.0,
            ..start
        };
        frame.move_to(origin);
        assert_eq!(frame.origin(), origin);
        let told_m = frame.told_m(&place_m);
        assert!((told_m - Vector3::new(3.0 - 111.2, -4.0, 7.0)).norm() < 0.1, "{told_m:?}");
        assert!((frame.meant_m(&told_m) - place_m).norm() < 1e-6);
    }
}
