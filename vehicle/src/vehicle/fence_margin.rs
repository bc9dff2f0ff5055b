//! ArduPilot's words for a border of the fence that is near (FENCE_OPTIONS, FENCE_MARGIN, FENCE_NTF_FREQ).

use nalgebra::Vector2;

use super::notice::Severity;
use super::proposal::Proposal;
use super::situation::Situation;
use crate::fence::Fence;

/// How often the borders are looked at, µs.
const PERIOD_US: u64 = 40_000;
/// Parts of the fence by the bits of FENCE_TYPE.
const PARTS: [&str; 4] = ["Max Alt", "Circle", "Polygon", "Min Alt"];

/// What has been told of borders that are near.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct FenceMargin {
    /// Of each part whether the vehicle has come into its margin and not left it inwards.
    near: [bool; 4],
    /// When a distance was told last, µs.
    told_us: Option<u64>,
}

impl FenceMargin {
    /// Tells that the vehicle comes into a margin, how far it is to the border there, and that it has left the margin inwards.
    pub fn watch(&mut self, situation: &Situation, proposal: &mut Proposal) {
        let settings = &situation.conduct.failsafe;
        if !situation.identity.is_ardupilot() || !settings.fence_options.tells_margin {
            *self = Self::default();
            return;
        }
        if !situation.time_us.is_multiple_of(PERIOD_US) {
            return;
        }
        let rooms_m = situation.fence().map_or([None; 4], |fence| rooms_m(situation, &fence));
        let before = self.near;
        for (part, room_m) in rooms_m.into_iter().enumerate() {
            // Beyond the border it stays as it was.
            let Some(room_m) = room_m.filter(|room_m| *room_m <= 0.0 || *room_m > settings.fence_margin_m)
            else {
                self.near[part] = room_m.is_some();
                continue;
            };
            if room_m > 0.0 && self.near[part] {
                self.near[part] = false;
                proposal.say(Severity::Info, format!("{} fence cleared margin breach", PARTS[part]));
            }
        }
        let is_new = (0..PARTS.len()).any(|part| self.near[part] && !before[part]);
        self.tell(is_new, &rooms_m, situation, proposal);
    }

    fn tell(
        &mut self,
        is_new: bool,
        rooms_m: &[Option<f64>; 4],
        situation: &Situation,
        proposal: &mut Proposal,
    ) {
        let nearest_m = (0..PARTS.len()).filter(|part| self.near[*part]).filter_map(|part| rooms_m[part]);
        let Some(nearest_m) = nearest_m.min_by(f64::total_cmp) else { return };
        let period_s = 1.0 / situation.conduct.failsafe.fence_tells_hz;
        let is_due = self.told_us.is_none_or(|told_us| {
            // Never, if the rate is zero.
            (situation.time_us - told_us) as f64 * 1e-6 >= period_s
        });
        if nearest_m > 0.0 && (is_new || is_due) {
            self.told_us = Some(situation.time_us);
            proposal.say(Severity::Info, format!("{} in {nearest_m:.1}m", names(&self.near)));
        }
    }
}

/// How far inside of each part the vehicle is, m; negative: beyond it; `None`: that part does not count.
fn rooms_m(situation: &Situation, fence: &Fence) -> [Option<f64>; 4] {
    let here_m = &situation.outputs.position_m;
    let height_m = fence.home_m.z - here_m.z;
    let distance_m = (here_m - fence.home_m).xy().norm();
    let floor_counts = situation.fence_parts().floor && situation.fence_floor_counts;
    [
        (fence.height_m > 0.0).then_some(fence.height_m - height_m),
        (fence.radius_m > 0.0).then_some(fence.radius_m - distance_m),
        zones_room_m(fence, here_m.xy()),
        floor_counts.then(|| height_m - situation.fence_floor_m()),
    ]
}

/// Of the zones: the least room, but of zones of which one is enough the most.
fn zones_room_m(fence: &Fence, here: Vector2<f64>) -> Option<f64> {
    let alone = fence.zones_alone().map(|zone| zone.room_m(here.into()));
    alone.chain(fence.room_in_any_m(here.into())).min_by(f64::total_cmp)
}

/// “Circle fence”, “Circle and Polygon fences”, “Max Alt, Circle and Polygon fences”.
fn names(near: &[bool; 4]) -> String {
    let names: Vec<&str> = PARTS.iter().zip(near).filter(|(_, near)| **near).map(|(name, _)| *name).collect();
    match names.split_last() {
        Some((last, [])) => format!("{last} fence"),
        Some((last, before)) => format!("{} and {last} fences", before.join(", ")),
        None => String::new(),
    }
}

#[cfg(test)]
mod tests {
    use super::{FenceMargin, PERIOD_US, names};
    use crate::fence::{Polygon, Shape, Zone};
    use crate::vehicle::scene::{Scene, said};

    /// A circle of 150 m and a square of 110 m to each side, as ArduPilot's own test has them, with a margin of 45 m.
    fn scene() -> Scene {
        let mut scene = Scene::hovering_at([0.0, 0.0, -10.0]).of_ardupilot();
        let settings = &mut scene.conduct.failsafe;
        (settings.fence_enabled, settings.fence_radius_m) = (true, 150.0);
        (settings.fence_margin_m, settings.fence_options.tells_margin) = (45.0, true);
        settings.fence_parts = crate::vehicle::failsafe::FenceParts::from_bits(6);
        let corners = vec![[-110.0, -110.0], [110.0, -110.0], [110.0, 110.0], [-110.0, 110.0]];
        let shape = Shape::Polygon(Polygon::new(corners).expect("a square"));
        scene.zones.zones.push(Zone { shape, inclusion: true });
        scene
    }

    fn told(margin: &mut FenceMargin, scene: &mut Scene, north_m: f64) -> Vec<String> {
        scene.come_to([north_m, 0.0, -10.0], [0.0; 3]);
        scene.outputs.time_us += PERIOD_US - scene.outputs.time_us % PERIOD_US;
        let requests = scene.show(|situation, proposal| margin.watch(situation, proposal));
        said(&requests).into_iter().map(str::to_owned).collect()
    }

    #[test]
    fn borders_that_come_near_are_told_with_their_distance_and_once_they_are_left() {
        let (mut scene, mut margin) = (scene(), FenceMargin::default());
        assert!(told(&mut margin, &mut scene, 64.0).is_empty());
        assert_eq!(told(&mut margin, &mut scene, 66.0), ["Polygon fence in 44.0m"]);
        assert!(told(&mut margin, &mut scene, 67.0).is_empty(), "not more often than once a second");
        scene.wait_us(1_000_000);
        assert_eq!(told(&mut margin, &mut scene, 68.0), ["Polygon fence in 42.0m"]);
        assert_eq!(told(&mut margin, &mut scene, 106.0), ["Circle and Polygon fences in 4.0m"]);
        scene.wait_us(1_000_000);
        assert!(told(&mut margin, &mut scene, 120.0).is_empty(), "beyond the border");
        scene.wait_us(1_000_000);
        assert_eq!(
            told(&mut margin, &mut scene, 104.0),
            ["Circle fence cleared margin breach", "Polygon fence in 6.0m"]
        );
        assert_eq!(told(&mut margin, &mut scene, 60.0), ["Polygon fence cleared margin breach"]);
        scene.conduct.failsafe.fence_options.tells_margin = false;
        assert!(told(&mut margin, &mut scene, 106.0).is_empty());
    }

    /// FENCE_NTF_FREQ = 0: only what is new.
    #[test]
    fn distances_need_not_be_told_again() {
        let (mut scene, mut margin) = (scene(), FenceMargin::default());
        scene.conduct.failsafe.fence_tells_hz = 0.0;
        assert_eq!(told(&mut margin, &mut scene, 70.0).len(), 1);
        scene.wait_us(10_000_000);
        assert!(told(&mut margin, &mut scene, 80.0).is_empty());
    }

    #[test]
    fn several_borders_are_named_of_ardupilot_names_them() {
        assert_eq!(names(&[true, true, true, false]), "Max Alt, Circle and Polygon fences");
        assert_eq!(names(&[false, false, false, true]), "Min Alt fence");
    }
}
