//! Where f(x, u) is not smooth: the branches that it takes, and the events at which they change.

pub(crate) mod branches;
pub(crate) mod plant_events;
pub(crate) mod plant_mode;
pub(crate) mod switch;
