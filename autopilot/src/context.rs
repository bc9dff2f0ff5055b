//! What a service works with.

use mavlink::dialects::ardupilotmega::MavProtocolCapability;
use vehicle::identity::Identity;
use vehicle::plan::PlanFault;
use vehicle::{Severity, Vehicle};

use crate::codec::command_name;
use crate::envelope::LinkProfile;
use crate::file_work::FileWorker;
use crate::log_queue::LogQueue;
use crate::outbox::Outbox;
use crate::parameters::Parameters;
use crate::stream::{Component, StreamTable};

/// The vehicle and the ways to its clients, as each call of a service gets them. What a service remembers between two calls is in
/// the service; it does not reach the state of another.
#[derive(Debug)]
pub struct Context {
    /// The vehicle.
    pub vehicle: Vehicle,
    /// Its parameters.
    pub parameters: Parameters,
    /// What is to be sent.
    pub outbox: Outbox,
    /// Does the work on files that clients can reach.
    pub files: Box<dyn FileWorker>,
    /// Messages that can be asked for.
    pub streams: StreamTable,
    /// Capabilities of all services together.
    pub capabilities: MavProtocolCapability,
    /// What each link is for, by the number of the link.
    pub links: Vec<LinkProfile>,
    /// A log that a client gets while it is written.
    pub log_queue: LogQueue,
    /// When the vehicle boots again, µs after its start, if it was asked to.
    pub reboot_us: Option<u64>,
    /// No regular message is due before this time, µs after the start, unless somebody asks for one.
    pub quiet_until_us: u64,
    /// Set by a method of a service that does nothing, and need not be called again.
    pub rests: bool,
}

impl Context {
    /// Whose conventions the vehicle follows.
    pub fn identity(&self) -> Identity {
        self.vehicle.identity()
    }

    /// System id of the vehicle.
    pub fn system_id(&self) -> u8 {
        self.parameters.system_id()
    }

    /// What messages of the table are made from.
    pub fn component(&self) -> Component<'_> {
        Component { vehicle: &self.vehicle, parameters: &self.parameters, capabilities: self.capabilities }
    }

    /// Sends a line for the pilot to everyone, unless it was said a moment ago.
    pub fn say(&mut self, severity: Severity, text: &str) {
        self.outbox.say(self.vehicle.time_us(), severity, text);
    }

    /// Tells everyone that a plan is rejected, with the number of the item, the name of its command and the reason. `name` is that
    /// of the kind of plan.
    pub fn reject_plan(&mut self, name: &str, fault: &PlanFault) {
        let reason = fault.described(self.identity(), command_name);
        self.say(Severity::Warning, &format!("{name} rejected: {reason}"));
    }
}
