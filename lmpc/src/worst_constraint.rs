//! The look for the constraint that signals violate most.

use core::iter;

use crate::Precision;
use crate::placed_limit::{COMPONENTS, PlacedLimit};

/// Samples that are looked at side by side.
const LANES: usize = 4;

/// The constraint that some signals violate most, by more than rounding, among those that are not active: the worst of the limits that
/// were looked at so far.
pub(crate) struct Worst<'a, T> {
    /// One over the length of the normal of each constraint.
    pub(crate) scales: &'a [T],
    pub(crate) active: &'a [usize],
    pub(crate) constraint: Option<usize>,
    /// What it leaves to its bound, per length of its normal: negative.
    pub(crate) room: T,
}

impl<T: Precision> Worst<'_, T> {
    /// Looks at a limit with some bounds, the least of which is told, that gives way by `give`.
    pub(crate) fn look_at(
        &mut self,
        limit: &PlacedLimit<T>,
        signals: &[T],
        (bounds, least_bound): (&[T], T),
        give: T,
    ) {
        if limit.components == 1 {
            return self.look_at_single(limit, signals, bounds, give);
        }
        // Most limits end here: up to this length no signal breaks them by more than rounding, and more than the worst so far, as
        // |direction · signal| ≤ |direction| |signal|.
        let room = (least_bound + give) * (T::one() + T::LIMIT) - self.room / limit.largest_scale;
        let longest = room / limit.longest;
        if longest > T::zero() && limit.largest_square(signals) <= longest * longest {
            return;
        }
        if limit.components == 2 {
            self.look_along::<2>(limit, signals, bounds, give);
        } else {
            self.look_along::<3>(limit, signals, bounds, give);
        }
    }

    /// Looks at signals with one component. They have few rows, so that the worst is found where its room is, in one go.
    fn look_at_single(&mut self, limit: &PlacedLimit<T>, signals: &[T], bounds: &[T], give: T) {
        let components = limit.components::<1>(signals);
        let (mut worst, mut least) = (None, self.room);
        for (side, (direction, bound)) in limit.directions.iter().zip(bounds).enumerate() {
            let upper = *bound + give;
            // No row of this direction counts as violated by less.
            let violated = -T::LIMIT * upper.abs() * limit.smallest_scale;
            let mut least_of_side = if violated < least { violated } else { least };
            let mut worst_sample = None;
            let rows = components[0].iter().zip(limit.scales(side, self.scales));
            for (sample, (signal, scale)) in rows.enumerate() {
                let room = room(direction, &[*signal], upper, *scale);
                if room < least_of_side {
                    (worst_sample, least_of_side) = (Some(sample), room);
                }
            }
            if let Some(sample) = worst_sample {
                (worst, least) = (Some((side, sample)), least_of_side);
            }
        }
        let Some((side, sample)) = worst else { return };
        let upper = bounds[side] + give;
        let scale = limit.scales(side, self.scales)[sample];
        self.take_worse(limit.row(sample, side), least, rounding(upper, &[components[0][sample]], scale));
        if self.room > least {
            self.look_along_sides(limit, &components, bounds, (side, give));
        }
    }

    /// Looks at signals with C components direction by direction, many samples side by side: at the direction with the least room on any
    /// sample, and at the others only if that is not what counts as violated.
    fn look_along<const C: usize>(&mut self, limit: &PlacedLimit<T>, signals: &[T], bounds: &[T], give: T) {
        let components = limit.components::<C>(signals);
        let (mut worst_side, mut least) = (None, self.room);
        // What is not bounded is not violated.
        for (side, (direction, bound)) in limit.directions.iter().zip(bounds).enumerate() {
            let upper = *bound + give;
            let least_of_side = least_room(direction, &components, upper, limit.scales(side, self.scales));
            // No row of this direction counts as violated by less.
            if least_of_side < least && least_of_side < -T::LIMIT * upper.abs() * limit.smallest_scale {
                (worst_side, least) = (Some(side), least_of_side);
            }
        }
        let Some(side) = worst_side else { return };
        // Mostly that is the constraint.
        self.look_along_side(limit, &components, (side, bounds[side] + give), least);
        if self.room > least {
            self.look_along_sides(limit, &components, bounds, (side, give));
        }
    }

    /// Looks at all directions sample by sample, beginning with one of them.
    fn look_along_sides<const C: usize>(
        &mut self,
        limit: &PlacedLimit<T>,
        components: &[&[T]; C],
        bounds: &[T],
        (first, give): (usize, T),
    ) {
        for side in iter::once(first).chain(0..bounds.len()) {
            self.look_along_side(limit, components, (side, bounds[side] + give), T::INFINITY);
        }
    }

    /// Looks at one direction sample by sample, at what leaves as little room as `most` or less.
    // Only for limits that are broken, so one copy for all who call.
    #[inline(never)]
    fn look_along_side<const C: usize>(
        &mut self,
        limit: &PlacedLimit<T>,
        components: &[&[T]; C],
        (side, upper): (usize, T),
        most: T,
    ) {
        let direction = &limit.directions[side];
        for (sample, scale) in limit.scales(side, self.scales).iter().enumerate() {
            let signal = components.map(|component| component[sample]);
            let room = room(direction, &signal, upper, *scale);
            if room <= most && room < self.room {
                self.take_worse(limit.row(sample, side), room, rounding(upper, &signal, *scale));
            }
        }
    }

    /// Takes a constraint, which leaves less room than the worst so far, if it is not active and leaves less than rounding does.
    fn take_worse(&mut self, constraint: usize, room: T, rounding: T) {
        if room < -rounding && !self.active.contains(&constraint) {
            (self.constraint, self.room) = (Some(constraint), room);
        }
    }
}

/// What a direction of a signal leaves to its bound, per length of its normal.
#[inline]
fn room<const C: usize, T: Precision>(factors: &[T; COMPONENTS], signal: &[T; C], upper: T, scale: T) -> T {
    let mut value = factors[0] * signal[0];
    for component in 1..C {
        value += factors[component] * signal[component];
    }
    (upper - value) * scale
}

/// What rounding may make of the [`room`] that a signal leaves to a bound.
#[inline]
fn rounding<const C: usize, T: Precision>(upper: T, signal: &[T; C], scale: T) -> T {
    let size: T = signal.iter().map(|component| component.abs()).sum();
    T::LIMIT * (upper.abs() + size) * scale
}

/// The least [`room`] of some samples, infinity of none; NaN counts as none.
#[inline]
fn least_room<const C: usize, T: Precision>(
    factors: &[T; COMPONENTS],
    components: &[&[T]; C],
    upper: T,
    scales: &[T],
) -> T {
    let smaller = |a: T, b: T| if b < a { b } else { a };
    let mut lanes = [T::INFINITY; LANES];
    let (blocks, rest) = scales.as_chunks::<LANES>();
    let in_blocks = components.map(|component| component.as_chunks::<LANES>());
    for (block, scales) in blocks.iter().enumerate() {
        let signals = in_blocks.map(|(blocks, _)| &blocks[block]);
        for lane in 0..LANES {
            let signal = signals.map(|component| component[lane]);
            lanes[lane] = smaller(lanes[lane], room(factors, &signal, upper, scales[lane]));
        }
    }
    let mut least = lanes.into_iter().fold(T::INFINITY, smaller);
    for (at, scale) in rest.iter().enumerate() {
        let signal = in_blocks.map(|(_, rest)| rest[at]);
        least = smaller(least, room(factors, &signal, upper, *scale));
    }
    least
}
