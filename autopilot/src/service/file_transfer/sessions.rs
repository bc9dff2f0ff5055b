//! Open files of all clients.

use super::message::{Client, Nak};

/// Open files at the same time, of all clients.
const MOST: usize = 16;
/// And of one of them; its oldest makes room.
const MOST_OF_ONE: usize = 4;
/// A file that nobody has asked anything of for this long makes room for others, µs of simulation time.
const IDLE_US: u64 = 10_000_000;

/// An open file.
#[derive(Debug)]
struct Session<C> {
    number: u8,
    client: Client,
    content: C,
    used_us: u64,
}

/// All of them.
#[derive(Debug)]
pub struct Sessions<C>(Vec<Session<C>>);

impl<C> Default for Sessions<C> {
    fn default() -> Self {
        Self(Vec::new())
    }
}

impl<C> Sessions<C> {
    /// Opens a file under the number that its client asks for: some clients tell their transfers apart by it. A second
    /// request under the same number is a retry whose answer was lost.
    pub fn open(&mut self, client: Client, number: u8, content: C, time_us: u64) -> Result<(), Nak> {
        self.close(client, number);
        if self.0.iter().filter(|open| open.client == client).count() >= MOST_OF_ONE {
            // It has forgotten to close them.
            if let Some(oldest) = self.0.iter().position(|open| open.client == client) {
                self.0.remove(oldest);
            }
        }
        if self.0.len() >= MOST {
            let idle = self.0.iter().position(|open| open.used_us + IDLE_US <= time_us);
            self.0.remove(idle.ok_or(Nak::NoSessionsAvailable)?);
        }
        self.0.push(Session { number, client, content, used_us: time_us });
        Ok(())
    }

    /// Closes a file, if it is open, and returns what it was.
    pub fn close(&mut self, client: Client, number: u8) -> Option<C> {
        let place = self.0.iter().position(|open| (open.client, open.number) == (client, number))?;
        Some(self.0.remove(place).content)
    }

    /// Closes all files of a client.
    pub fn reset(&mut self, client: Client) {
        self.0.retain(|open| open.client != client);
    }

    /// An open file that is used now.
    pub fn find(&mut self, client: Client, number: u8, time_us: u64) -> Result<&mut C, Nak> {
        let found = self.0.iter_mut().find(|open| (open.client, open.number) == (client, number));
        let open = found.ok_or(Nak::InvalidSession)?;
        open.used_us = time_us;
        Ok(&mut open.content)
    }
}
