//! Where the four rotors are and which way they turn.

use nalgebra::{Matrix4, Vector2};
use serde::{Deserialize, Serialize};

use crate::ConfigurationError;

/// Coordinates that differ by less than this, arm lengths, are the same.
const SAME: f64 = 1e-9;
/// Largest share of a rotor's thrust, per arm length, that may be needed for one unit of torque: beyond it rotors are too
/// close to a line to control an axis.
const LARGEST_SHARE: f64 = 100.0;

/// Which way a rotor turns, seen from above.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Direction {
    /// To the right: its drag turns the body to the left.
    Clockwise,
    /// To the left: its drag turns the body to the right.
    Counterclockwise,
}

impl Direction {
    /// Sign of its drag torque about the body's down axis.
    #[inline]
    pub fn torque_sign(self) -> f64 {
        match self {
            Self::Clockwise => -1.0,
            Self::Counterclockwise => 1.0,
        }
    }
}

/// One rotor, in the plane of the centre of mass.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Rotor {
    /// Forward of the centre of mass, arm lengths.
    pub x: f64,
    /// Right of the centre of mass, arm lengths.
    pub y: f64,
    /// Which way it turns.
    pub direction: Direction,
}

/// The four rotors, in the order of all arrays of rotor speeds. The vehicle has a foot at each.
///
/// Equal thrusts make no torque: the rotors' centre is the centre of mass, and two turn each way.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct RotorLayout {
    /// The rotors.
    pub rotors: [Rotor; 4],
}

/// The paper's (Figure 1).
impl Default for RotorLayout {
    fn default() -> Self {
        Self::plus()
    }
}

impl RotorLayout {
    /// "+": front, right, back and left; front and back turn clockwise.
    pub fn plus() -> Self {
        Self::alternating([[1.0, 0.0], [0.0, 1.0], [-1.0, 0.0], [0.0, -1.0]])
    }

    /// "X": front right, back right, back left and front left, each an arm's length from the centre of mass; front right
    /// and back left turn clockwise.
    pub fn x() -> Self {
        Self::h(1.0)
    }

    /// "H": as [`RotorLayout::x`], with a distance from front to back that is `ratio` times the one from left to right.
    pub fn h(ratio: f64) -> Self {
        let half_width = 1.0 / libm::hypot(1.0, ratio);
        let (x, y) = (ratio * half_width, half_width);
        Self::alternating([[x, y], [-x, y], [-x, -y], [x, -y]])
    }

    /// The same rotors, each turning the other way.
    #[must_use]
    pub fn reversed(self) -> Self {
        let rotors = self.rotors.map(|rotor| {
            let direction = match rotor.direction {
                Direction::Clockwise => Direction::Counterclockwise,
                Direction::Counterclockwise => Direction::Clockwise,
            };
            Rotor { direction, ..rotor }
        });
        Self { rotors }
    }

    /// Rotors clockwise around the vehicle, the first of which turns clockwise.
    pub(crate) fn alternating(places: [[f64; 2]; 4]) -> Self {
        let directions = [Direction::Clockwise, Direction::Counterclockwise];
        Self {
            rotors: core::array::from_fn(|index| {
                let [x, y] = places[index];
                Rotor { x, y, direction: directions[index % 2] }
            }),
        }
    }

    /// Where each rotor is, for a person.
    pub fn names(&self) -> [&'static str; 4] {
        self.rotors.map(|rotor| match (sign(rotor.x), sign(rotor.y)) {
            (1, 0) => "front",
            (1, 1) => "front right",
            (0, 1) => "right",
            (-1, 1) => "back right",
            (-1, 0) => "back",
            (-1, -1) => "back left",
            (0, -1) => "left",
            (1, -1) => "front left",
            _ => "centre",
        })
    }

    /// Distance of the outermost rotor from the centre of mass, arm lengths.
    #[inline]
    pub(crate) fn reach(&self) -> f64 {
        self.rotors.iter().map(|rotor| libm::hypot(rotor.x, rotor.y)).fold(0.0, f64::max)
    }

    /// Distance of the innermost rotor from the centre of mass, arm lengths.
    pub(crate) fn nearest(&self) -> f64 {
        self.rotors.iter().map(|rotor| libm::hypot(rotor.x, rotor.y)).fold(f64::INFINITY, f64::min)
    }

    /// Thrust and torques, of the thrusts of the rotors: (1) without its constants. Rows F, τ_φ, τ_θ per arm length, and
    /// τ_ψ per drag torque.
    pub(crate) fn allocation(&self) -> Matrix4<f64> {
        let row = |value: fn(&Rotor) -> f64| self.rotors.map(|rotor| value(&rotor));
        let rows = [
            [1.0; 4],
            row(|rotor| -rotor.y),
            row(|rotor| rotor.x),
            row(|rotor| rotor.direction.torque_sign()),
        ];
        Matrix4::from_fn(|i, j| rows[i][j])
    }

    /// The inverse of [`RotorLayout::allocation`].
    ///
    /// # Errors
    /// [`ConfigurationError::Layout`] when equal thrusts make a torque, or the rotors cannot make every torque.
    pub(crate) fn inverse_allocation(&self) -> Result<Matrix4<f64>, ConfigurationError> {
        let refused = |reason| Err(ConfigurationError::Layout { reason });
        if self.rotors.iter().any(|rotor| !(rotor.x.is_finite() && rotor.y.is_finite())) {
            return refused("a rotor's place is not finite");
        }
        let allocation = self.allocation();
        let [_, roll, pitch, yaw]: [f64; 4] = allocation.column_sum().into();
        if libm::fabs(roll) > SAME || libm::fabs(pitch) > SAME {
            return refused("the rotors' centre is not the centre of mass");
        }
        if yaw != 0.0 {
            return refused("as many rotors must turn one way as the other");
        }
        match allocation.try_inverse() {
            Some(inverse) if inverse.amax() <= LARGEST_SHARE => Ok(inverse),
            _ => refused("the rotors cannot make thrust and all three torques"),
        }
    }

    /// How the rotors lie when one of them is lost, if they lie opposite one another in pairs that turn the same way.
    ///
    /// # Errors
    /// [`ConfigurationError::Layout`] if they do not.
    pub(crate) fn around(&self, lost: usize) -> Result<RotorsAround, ConfigurationError> {
        let refused = || ConfigurationError::Layout {
            reason: "its rotors are not opposite in pairs that turn the same way",
        };
        let rotor = self.rotors.get(lost).ok_or_else(refused)?;
        let place = |rotor: &Rotor| Vector2::new(rotor.x, rotor.y);
        let opposed = |one: &Rotor, other: &Rotor| {
            one.direction == other.direction && (place(one) + place(other)).amax() < SAME
        };
        let opposite = self.rotors.iter().position(|other| opposed(rotor, other)).ok_or_else(refused)?;
        let mut sides = (0..4).filter(|index| *index != lost && *index != opposite);
        let (Some(one), Some(other)) = (sides.next(), sides.next()) else { return Err(refused()) };
        if !opposed(&self.rotors[one], &self.rotors[other]) {
            return Err(refused());
        }
        let distance = place(rotor).norm();
        let towards = place(rotor) / distance;
        let mirrored = rotor.direction == Direction::Counterclockwise;
        let around = |right: usize, left: usize| {
            let turned = turned(&towards, mirrored, &place(&self.rotors[right]));
            RotorsAround { places: [lost, right, opposite, left], towards, mirrored, distance, right: turned }
        };
        let first = around(one, other);
        Ok(if first.right.y > 0.0 { first } else { around(other, one) })
    }
}

/// The rotors in axes that are turned so that a lost one is the front one, and mirrored, if need be, so that the two beside
/// it drive a spin to the right.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct RotorsAround {
    /// Indices of the lost rotor, and of those on the right, opposite and on the left.
    pub(crate) places: [usize; 4],
    /// Unit vector from the centre of mass to the lost rotor, in the body.
    pub(crate) towards: Vector2<f64>,
    /// Whether the axes are mirrored.
    pub(crate) mirrored: bool,
    /// Of the lost rotor and the opposite one from the centre of mass, arm lengths.
    pub(crate) distance: f64,
    /// Place of the right rotor in these axes, arm lengths; the left one is opposite to it.
    pub(crate) right: Vector2<f64>,
}

impl RotorsAround {
    /// A vector of the body's plane in these axes.
    pub(crate) fn turned(&self, vector: &Vector2<f64>) -> Vector2<f64> {
        turned(&self.towards, self.mirrored, vector)
    }
}

fn turned(towards: &Vector2<f64>, mirrored: bool, vector: &Vector2<f64>) -> Vector2<f64> {
    let across = towards.x * vector.y - towards.y * vector.x;
    Vector2::new(towards.dot(vector), if mirrored { -across } else { across })
}

fn sign(coordinate: f64) -> i8 {
    if libm::fabs(coordinate) < SAME {
        0
    } else if coordinate > 0.0 {
        1
    } else {
        -1
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::{Matrix4, Vector2, Vector4};

    use super::{Direction, Rotor, RotorLayout};
    use crate::ConfigurationError;

    fn layout(places: [[f64; 2]; 4]) -> RotorLayout {
        RotorLayout::alternating(places)
    }

    #[test]
    fn rotors_are_named_after_their_places() {
        assert_eq!(RotorLayout::plus().names(), ["front", "right", "back", "left"]);
        assert_eq!(RotorLayout::x().names(), ["front right", "back right", "back left", "front left"]);
        let centred = layout([[1e-12, -1e-12], [1e-8, 0.0], [0.0, -1e-8], [-1e-8, 1e-8]]);
        assert_eq!(centred.names(), ["centre", "front", "left", "back right"]);
    }

    #[test]
    fn reach_and_nearest_are_those_of_the_outermost_and_innermost_rotor() {
        let uneven = layout([[3.0, 4.0], [-1.0, 0.0], [0.0, 2.0], [0.6, -0.8]]);
        assert!((uneven.reach() - 5.0).abs() < 1e-15 && (uneven.nearest() - 1.0).abs() < 1e-15);
    }

    /// In the "+" a quarter of the thrust each, half of a torque on the two rotors of its axis, a quarter of the yaw.
    #[test]
    fn the_plus_frame_is_inverted_by_hand() {
        let inverse = RotorLayout::plus().inverse_allocation().unwrap();
        let expected = Matrix4::new(
            0.25, 0.0, 0.5, -0.25, 0.25, -0.5, 0.0, 0.25, 0.25, 0.0, -0.5, -0.25, 0.25, 0.5, 0.0, 0.25,
        );
        assert!((inverse - expected).amax() < 1e-15, "{inverse}");
    }

    #[test]
    fn every_frame_makes_the_thrust_and_torques_it_is_asked_for() {
        let wanted = Vector4::new(4.0, 0.3, -0.2, 0.1);
        for frame in [RotorLayout::plus(), RotorLayout::x(), RotorLayout::h(1.7)] {
            let thrusts = frame.inverse_allocation().unwrap() * wanted;
            let mut made = Vector4::zeros();
            for (rotor, thrust) in frame.rotors.iter().zip(&thrusts) {
                let drag = if rotor.direction == Direction::Clockwise { -thrust } else { *thrust };
                // r × F of a force up, FRD
                made += Vector4::new(*thrust, -rotor.y * thrust, rotor.x * thrust, drag);
            }
            assert!((made - wanted).amax() < 1e-14, "{made}");
        }
    }

    #[test]
    fn frames_that_cannot_hover_level_or_steer_are_refused_with_the_reason() {
        let reason = |frame: &RotorLayout| match frame.inverse_allocation() {
            Err(ConfigurationError::Layout { reason }) => reason,
            other => panic!("{other:?}"),
        };
        let plus = RotorLayout::plus();
        for place in [f64::NAN, f64::INFINITY] {
            let mut frame = plus;
            frame.rotors[2].x = place;
            assert_eq!(reason(&frame), "a rotor's place is not finite");
            let mut frame = plus;
            frame.rotors[1].y = place;
            assert_eq!(reason(&frame), "a rotor's place is not finite");
        }
        for offset in [-1e-8, 1e-8] {
            let mut frame = plus;
            frame.rotors[3].x += offset;
            assert_eq!(reason(&frame), "the rotors' centre is not the centre of mass");
            let mut frame = plus;
            frame.rotors[3].y += offset;
            assert_eq!(reason(&frame), "the rotors' centre is not the centre of mass");
        }
        let mut rounded = plus;
        rounded.rotors[3].x += 1e-12;
        assert!(rounded.inverse_allocation().is_ok());
        for direction in [Direction::Clockwise, Direction::Counterclockwise] {
            let mut frame = plus;
            frame.rotors = frame.rotors.map(|rotor| Rotor { direction, ..rotor });
            assert_eq!(reason(&frame), "as many rotors must turn one way as the other");
        }
        // Two rows of rotors, 2 y apart: a unit of roll takes 1/(4 y) of thrust of each.
        let row = |y: f64| layout([[1.0, y], [-1.0, y], [-1.0, -y], [1.0, -y]]);
        assert!(row(1.0 / 398.0).inverse_allocation().is_ok());
        assert_eq!(reason(&row(1.0 / 402.0)), "the rotors cannot make thrust and all three torques");
        assert_eq!(reason(&row(0.0)), "the rotors cannot make thrust and all three torques");
    }

    /// Whichever rotor is lost, the same picture: it is in front, the others follow, and the two beside it drive a spin
    /// to the right in these axes.
    #[test]
    fn a_lost_rotor_is_the_front_one_of_axes_of_its_own() {
        for frame in [RotorLayout::plus(), RotorLayout::x(), RotorLayout::h(1.4), RotorLayout::h(0.6)] {
            for lost in 0..4 {
                let around = frame.around(lost).unwrap();
                let [front, right, back, left] = around.places;
                let place = |rotor: usize| Vector2::new(frame.rotors[rotor].x, frame.rotors[rotor].y);
                assert_eq!(front, lost);
                assert!((place(back) + place(lost)).norm() < 1e-12);
                assert!((place(left) + place(right)).norm() < 1e-12);
                assert_eq!(around.mirrored, frame.rotors[lost].direction == Direction::Counterclockwise);
                assert!((around.distance - place(lost).norm()).abs() < 1e-15);
                assert!((around.towards * around.distance - place(lost)).norm() < 1e-15);
                // Turned and mirrored, but neither stretched nor sheared.
                let ahead = around.turned(&place(lost));
                assert!((ahead - Vector2::new(around.distance, 0.0)).norm() < 1e-15, "{ahead}");
                let beside = around.turned(&place(right));
                assert!((beside - around.right).norm() < 1e-15 && beside.y > 0.0, "{beside}");
                assert!((beside.norm() - place(right).norm()).abs() < 1e-15);
                assert!((beside.dot(&ahead) - place(right).dot(&place(lost))).abs() < 1e-15);
                let across = place(lost).x * place(right).y - place(lost).y * place(right).x;
                assert_eq!(across < 0.0, around.mirrored, "right of a clockwise rotor, left of another");
            }
        }
    }

    #[test]
    fn frames_without_opposite_pairs_have_no_such_axes() {
        let plus = RotorLayout::plus();
        assert!(plus.around(4).is_err());
        let mut other_ways = plus;
        other_ways.rotors[2].direction = Direction::Counterclockwise;
        other_ways.rotors[1].direction = Direction::Clockwise;
        let mut sides_turn_apart = plus;
        sides_turn_apart.rotors[1].direction = Direction::Clockwise;
        let mut bent = plus;
        bent.rotors[1].x = 0.1;
        for (frame, lost) in [(other_ways, 0), (sides_turn_apart, 0), (bent, 0), (bent, 1)] {
            assert!(matches!(frame.around(lost), Err(ConfigurationError::Layout { .. })), "{frame:?}");
        }
    }
}
