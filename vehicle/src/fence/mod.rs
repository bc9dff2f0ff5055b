//! Where the vehicle may be: circles and polygons to stay in or out of, a greatest distance from home and a greatest height.
//!
//! ```text
//!  plan of kind fence ──► zones ┐
//!  parameters, home ────────────┴─► fence ──► breach at a place, margin to the nearest border
//! ```

mod breach;
mod fence_switch;
mod inclusions;
mod polygon;
mod route;
mod zone;
mod zones;

pub use breach::{Breach, Fence};
pub use fence_switch::FenceSwitch;
pub use inclusions::Inclusions;
pub use polygon::{Polygon, PolygonFault, distance_to};
pub use route::{Progress, RouteSearch};
pub use zone::{Shape, Zone};
pub use zones::Zones;
