//! The log protocol: what is asked for, and what goes out when.

use std::sync::mpsc::{Receiver, Sender, channel};

use mavlink::dialects::ardupilotmega::MavMessage;
use vehicle::Severity;

use super::catalog::Catalog;
use super::download::Downloads;
use super::job::{Answer, EraseJob, ListJob, ReadJob};
use crate::codec::{Frame, id};
use crate::context::Context;
use crate::envelope::{Destination, Origin, PeerId};
use crate::service::Service;

/// Lists and downloads that are under way.
#[derive(Debug)]
pub struct LogServer {
    catalog: Catalog,
    downloads: Downloads,
    /// Whether jobs are listing or erasing.
    listing: bool,
    erasing: bool,
    answers: Receiver<Answer>,
    /// A copy for each job.
    to_answers: Sender<Answer>,
}

impl Default for LogServer {
    fn default() -> Self {
        let (to_answers, answers) = channel();
        Self {
            catalog: Catalog::default(),
            downloads: Downloads::default(),
            listing: false,
            erasing: false,
            answers,
            to_answers,
        }
    }
}

impl Service for LogServer {
    fn summary(&self) -> &'static str {
        "Lists and downloads of flight logs"
    }

    fn answers(&self) -> &'static [u32] {
        &[id::LOG_ENTRY, id::LOG_DATA]
    }

    fn messages(&self) -> &'static [u32] {
        &[id::LOG_REQUEST_LIST, id::LOG_REQUEST_DATA, id::LOG_REQUEST_END, id::LOG_ERASE]
    }

    fn receive(&mut self, context: &mut Context, origin: &Origin, frame: &Frame) {
        match frame.message_id() {
            id::LOG_REQUEST_LIST => self.request_list(context, origin, frame),
            id::LOG_REQUEST_DATA => self.request_data(context, origin, frame),
            id::LOG_REQUEST_END => self.downloads.end(origin.peer),
            _ => self.erase(context, origin),
        }
    }

    fn is_answering(&self) -> bool {
        self.listing || self.erasing || self.catalog.is_wanted() || self.downloads.are_under_way()
    }

    fn transfer(&mut self, context: &mut Context, turns: usize, has_room: &dyn Fn(PeerId) -> Option<bool>) {
        let first_id = first_id(context);
        self.catalog.retain(|peer| has_room(peer).is_some());
        self.downloads.retain(|peer| has_room(peer).is_some());
        self.take_answers(context);
        let is_ready = |peer| has_room(peer) == Some(true);
        for _ in 0..turns {
            self.read_ahead(context);
            // Lists are short, and people wait for them.
            if let Some((peer, entry)) = self.catalog.next(first_id, is_ready) {
                context.outbox.send(Destination::Peer(peer), MavMessage::LOG_ENTRY(entry));
            } else if let Some((peer, piece)) = self.downloads.next(is_ready) {
                context.outbox.send(Destination::Peer(peer), MavMessage::LOG_DATA(piece));
            } else {
                return;
            }
        }
    }
}

impl LogServer {
    /// LOG_REQUEST_LIST: an entry for each, or one that says that there is none.
    fn request_list(&mut self, context: &mut Context, origin: &Origin, frame: &Frame) {
        let (first, last) = (frame.payload().u16(0), frame.payload().u16(2));
        // Asking for some only is asking again: their ids must be the ones that were told.
        if (first, last) == (0, u16::MAX) || !self.catalog.is_known() {
            self.catalog.wait(origin.peer, first..=last);
            self.list(context, origin.peer);
        } else {
            self.catalog.send(origin.peer, &(first..=last), first_id(context));
        }
    }

    /// Lists the logs, unless that is under way: one listing serves everyone who waits for one.
    fn list(&mut self, context: &mut Context, client: PeerId) {
        // Those who wait ask again if the queue is full.
        self.listing =
            self.listing || context.files.submit(client, Box::new(ListJob(self.to_answers.clone()))).is_ok();
    }

    /// LOG_REQUEST_DATA: begins a download, or goes on with it elsewhere.
    fn request_data(&mut self, context: &mut Context, origin: &Origin, frame: &Frame) {
        let (offset, count, id) = (frame.payload().u32(0), frame.payload().u32(4), frame.payload().u16(8));
        self.downloads.begin(origin.peer, id, (offset, count));
        if !self.catalog.is_known() {
            self.list(context, origin.peer);
        }
        self.name_downloads(context);
    }

    /// Gives downloads the names of their logs, once these are known. Who asks for what is not there gets an empty piece: the end.
    fn name_downloads(&mut self, context: &Context) {
        if self.listing {
            return;
        }
        let first_id = first_id(context);
        for download in self.downloads.iter_mut().filter(|download| download.name.is_none()) {
            let log =
                download.id.checked_sub(first_id).and_then(|place| self.catalog.get(usize::from(place)));
            download.name = log.map(|log| log.name.clone());
            download.missing = download.name.is_none();
        }
    }

    /// Reads what downloads need next.
    fn read_ahead(&mut self, context: &mut Context) {
        let mut submitted = false;
        for download in self.downloads.iter_mut().filter(|download| download.is_dry()) {
            let Some(name) = download.name.clone() else { continue };
            let job = ReadJob {
                name,
                file: download.ahead.take().map(|ahead| ahead.file),
                offset: u64::from(download.next),
                download: download.number,
                answers: self.to_answers.clone(),
            };
            download.reading = context.files.submit(download.peer, Box::new(job)).is_ok();
            submitted |= download.reading;
        }
        if submitted {
            self.take_answers(context);
        }
    }

    /// LOG_ERASE: removes the logs of all flights that are over.
    fn erase(&mut self, context: &mut Context, origin: &Origin) {
        if self.erasing {
            return;
        }
        self.downloads.clear();
        self.catalog.forget();
        let job = EraseJob { origin: *origin, answers: self.to_answers.clone() };
        match context.files.submit(origin.peer, Box::new(job)) {
            Ok(()) => self.erasing = true,
            Err(full) => context.say(Severity::Warning, &format!("Logs not erased: {full}")),
        }
    }

    /// Takes in what jobs have found out.
    fn take_answers(&mut self, context: &mut Context) {
        while let Ok(answer) = self.answers.try_recv() {
            match answer {
                Answer::Listed(logs) => {
                    self.listing = false;
                    self.catalog.set(logs, first_id(context));
                    self.name_downloads(context);
                }
                Answer::Read(ahead, number) => self.downloads.take_in(number, ahead),
                Answer::Erased(origin, result) => {
                    self.erasing = false;
                    self.catalog.forget();
                    let by = format!("{}/{}", origin.system, origin.component);
                    let (severity, text) = match result {
                        Ok(()) => (Severity::Info, format!("Logs erased by {by}")),
                        Err(error) => (Severity::Warning, format!("Logs not erased: {error}")),
                    };
                    context.say(severity, &text);
                }
            }
        }
    }
}

/// The id of the first log. Clients expect PX4's to count from zero, and ArduPilot's from one.
fn first_id(context: &Context) -> u16 {
    u16::from(context.identity().is_ardupilot())
}
