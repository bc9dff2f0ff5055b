//! Whether a place is allowed.

use std::fmt;

use nalgebra::Vector3;

use super::{Inclusions, Zone, Zones};

/// What of the fence forbids a place.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Breach {
    /// Higher above home than this, m.
    Height(f64),
    /// Lower above home than this, m.
    Floor(f64),
    /// Farther from home than this, m.
    Distance(f64),
    /// Outside of the areas to stay in.
    Outside,
    /// Inside of the area to stay out of with this number.
    Inside(usize),
    /// The way leads through the area to stay out of with this number.
    Through(usize),
}

impl Breach {
    /// What of the fence it is of, in ArduPilot's words.
    pub fn ardupilot_name(&self) -> &'static str {
        match self {
            Self::Height(_) => "Max Alt",
            Self::Floor(_) => "Min Alt",
            Self::Distance(_) => "Circle",
            Self::Outside | Self::Inside(_) | Self::Through(_) => "Polygon",
        }
    }
}

impl fmt::Display for Breach {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Height(most_m) => write!(formatter, "higher than {most_m:.0} m above home"),
            Self::Floor(least_m) => write!(formatter, "lower than {least_m:.0} m above home"),
            Self::Distance(most_m) => write!(formatter, "farther than {most_m:.0} m from home"),
            Self::Outside => write!(formatter, "outside the fence"),
            Self::Inside(_) => write!(formatter, "in an exclusion zone"),
            Self::Through(_) => write!(formatter, "through an exclusion zone"),
        }
    }
}

/// The fence, as far as it is looked at.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fence<'a> {
    /// Areas.
    pub zones: Option<&'a Zones>,
    /// How several areas to stay in combine.
    pub inclusions: Inclusions,
    /// What the distance and the height are from, NED, m.
    pub home_m: Vector3<f64>,
    /// Greatest distance, m; 0: any.
    pub radius_m: f64,
    /// Greatest height, m; 0: any.
    pub height_m: f64,
}

impl Fence<'_> {
    /// Whether there is anything to keep to.
    pub fn bounds(&self) -> bool {
        let zones = self.zones.is_some_and(|zones| !zones.zones.is_empty());
        zones || self.radius_m > 0.0 || self.height_m > 0.0
    }

    /// The zones that have to be kept to whatever the others are: of several to stay in, one may be enough.
    pub fn zones_alone(&self) -> impl Iterator<Item = &Zone> {
        self.all_zones().filter(|zone| self.holds_alone(zone))
    }

    /// The room at a point in that of the other zones which has the most, m: it is enough to be in one. `None` without any.
    pub fn room_in_any_m(&self, point: [f64; 2]) -> Option<f64> {
        let others = self.all_zones().filter(|zone| !self.holds_alone(zone));
        others.map(|zone| zone.room_m(point)).max_by(f64::total_cmp)
    }

    fn all_zones(&self) -> impl Iterator<Item = &Zone> {
        self.zones.iter().flat_map(|zones| &zones.zones)
    }

    fn holds_alone(&self, zone: &Zone) -> bool {
        !zone.inclusion || self.inclusions == Inclusions::All
    }

    /// What forbids a place, NED, m, if anything does.
    pub fn breach(&self, place_m: &Vector3<f64>) -> Option<Breach> {
        let Self { home_m, radius_m, height_m, .. } = *self;
        if height_m > 0.0 && home_m.z - place_m.z > height_m {
            return Some(Breach::Height(height_m));
        }
        if radius_m > 0.0 && (place_m - home_m).xy().norm() > radius_m {
            return Some(Breach::Distance(radius_m));
        }
        let point = [place_m.x, place_m.y];
        let zones = &self.zones?.zones;
        if let Some(number) = zones.iter().position(|zone| !zone.inclusion && zone.forbids(point)) {
            return Some(Breach::Inside(number));
        }
        let outside = zones.iter().filter(|zone| zone.inclusion).map(|zone| zone.forbids(point));
        self.inclusions.forbid(outside).then_some(Breach::Outside)
    }

    /// What forbids a place, NED, m, or the straight way to it.
    pub fn breach_on_way(&self, from_m: &Vector3<f64>, to_m: &Vector3<f64>) -> Option<Breach> {
        self.breach(to_m).or_else(|| self.breach_between(from_m, to_m))
    }

    /// The area to stay out of that the straight way between two places, NED, m, leads through. One that it begins in does not
    /// count: it has to be left anyway.
    pub fn breach_between(&self, from_m: &Vector3<f64>, to_m: &Vector3<f64>) -> Option<Breach> {
        let way = ([from_m.x, from_m.y], [to_m.x, to_m.y]);
        let zones = self.zones?.zones.iter();
        let number = zones
            .map(|zone| !zone.inclusion && !zone.forbids(way.0) && zone.shape.is_entered_by(&way))
            .position(|entered| entered)?;
        Some(Breach::Through(number))
    }
}
