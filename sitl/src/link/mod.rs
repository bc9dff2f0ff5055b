//! Links: transports, their peers, and forwarding between them.

mod allowance;
mod descriptors;
#[cfg(test)]
mod documented;
mod echo;
mod endpoint;
mod error;
mod forwarding;
mod inbox;
mod links;
mod lost;
mod open;
mod peer;
mod readiness;
#[cfg(unix)]
mod serial;
mod signing_setup;
mod strangers;
mod tcp;
mod transport;
mod turns;
mod udp;

pub use endpoint::{Endpoint, LinkSpecification, default_links};
pub use error::LinkError;
pub use links::{Links, Received, Turn};
pub use lost::Lost;
pub use readiness::Readiness;
pub use signing_setup::{SetupRefusal, SetupRules, SigningSetup};
pub(crate) use transport::is_nothing_yet;
pub(crate) use turns::Turns;
pub(crate) use udp::resolve;
