//! Packed plans and parameters that are being written. They change the flight when they are closed, so they depend on nothing but received
//! frames and simulation time: no disk has a part in them.

use vehicle::Severity;
use vehicle::plan::PlanKind;

use super::answered::Answered;
use super::message::{Client, Nak, Reply, Request, opcode};
use super::sessions::Sessions;
use super::{parameter_pack, plan_pack, root};
use crate::context::Context;
use crate::service::parameter;

/// What is packed.
#[derive(Clone, Copy, Debug)]
enum Pack {
    Plan(PlanKind),
    Parameters,
}

/// A packed file as far as it has come.
#[derive(Debug)]
struct Received {
    pack: Pack,
    bytes: Vec<u8>,
}

impl Pack {
    /// That of a plain path.
    fn of(path: &str) -> Option<Self> {
        if path == parameter_pack::PATH {
            Some(Self::Parameters)
        } else {
            plan_pack::kind_of(path).map(Self::Plan)
        }
    }

    /// Bytes of the largest one that is taken.
    fn largest(self) -> usize {
        match self {
            Self::Plan(kind) => plan_pack::largest(kind),
            Self::Parameters => parameter_pack::LARGEST,
        }
    }
}

/// All of them, and what was done lately.
#[derive(Debug, Default)]
pub struct PackUploads {
    open: Sessions<Received>,
    answered: Answered,
}

impl PackUploads {
    /// Carries out a request and returns its answer, if it is about a packed file that is written.
    pub fn take(
        &mut self,
        context: &mut Context,
        client: Client,
        request: &Request,
        time_us: u64,
    ) -> Option<Reply> {
        if Answered::concerns(request)
            && let Some(reply) = self.answered.find(client, request, time_us)
        {
            return Some(reply);
        }
        let result = self.carry_out(context, client, request, time_us)?;
        let reply = Reply::to(request, result);
        self.answered.remember(client, request, &reply, time_us);
        Some(reply)
    }

    fn carry_out(
        &mut self,
        context: &mut Context,
        client: Client,
        request: &Request,
        time_us: u64,
    ) -> Option<Result<Vec<u8>, Nak>> {
        match request.opcode {
            opcode::CREATE_FILE | opcode::OPEN_FILE_WO => {
                let path = request.text().and_then(root::plain).ok();
                let Some(pack) = path.as_deref().and_then(Pack::of) else {
                    // The number is another file's from now on.
                    self.open.close(client, request.session);
                    return None;
                };
                let opened =
                    self.open.open(client, request.session, Received { pack, bytes: Vec::new() }, time_us);
                Some(opened.map(|()| 0_u32.to_le_bytes().to_vec()))
            }
            opcode::OPEN_FILE_RO => {
                self.open.close(client, request.session);
                None
            }
            opcode::WRITE_FILE => {
                let received = self.open.find(client, request.session, time_us).ok()?;
                Some(received.write(request))
            }
            opcode::TERMINATE_SESSION => {
                let Received { pack, bytes } = self.open.close(client, request.session)?;
                let taken = match pack {
                    Pack::Plan(kind) => take_plan(context, kind, &bytes),
                    Pack::Parameters => take_parameters(context, &bytes),
                };
                Some(taken.map(|()| Vec::new()))
            }
            opcode::RESET_SESSIONS => {
                self.open.reset(client);
                self.answered.forget(client);
                None
            }
            _ => None,
        }
    }
}

impl Received {
    fn write(&mut self, request: &Request) -> Result<Vec<u8>, Nak> {
        let start = request.offset as usize;
        let end = start.saturating_add(request.data.len());
        if end > self.pack.largest() {
            return Err(Nak::NoSpace);
        }
        self.bytes.resize(self.bytes.len().max(end), 0);
        for (byte, given) in self.bytes.iter_mut().skip(start).zip(&request.data) {
            *byte = *given;
        }
        Ok((request.data.len() as u32).to_le_bytes().to_vec())
    }
}

/// Takes a packed plan over, or says why not: clients do not look at the answer to a close.
fn take_plan(context: &mut Context, kind: PlanKind, bytes: &[u8]) -> Result<(), Nak> {
    let items = plan_pack::unpack(bytes, kind);
    items.and_then(|items| context.vehicle.set_plan(kind, items)).map_err(|fault| {
        context.reject_plan(kind.name(), &fault);
        Nak::Fail
    })
}

/// Sets the parameters of a packed file, one after the other, as PARAM_SET does; what is refused is said, and the others are set.
fn take_parameters(context: &mut Context, bytes: &[u8]) -> Result<(), Nak> {
    let values = parameter_pack::unpack(bytes).map_err(|reason| {
        context.say(Severity::Warning, &format!("Parameter file rejected: {reason}"));
        Nak::Fail
    })?;
    let mut result = Ok(());
    for (name, value) in values {
        match context.parameters.set(&name, value, &mut context.vehicle) {
            Ok(()) => parameter::tell(context, &name),
            Err(error) => {
                context.say(Severity::Warning, &error.to_string());
                result = Err(Nak::Fail);
            }
        }
    }
    result
}
