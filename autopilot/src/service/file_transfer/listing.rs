//! Listings of folders: a client asks for them in pieces, and a folder is read once for all of them.

use super::message::{Client, Nak};

/// Clients whose listings are kept; the oldest makes room.
const MOST: usize = 8;
/// A listing that is not read on for this long is read again, µs of simulation time.
const IDLE_US: u64 = 10_000_000;

/// A folder as it was when its listing began.
#[derive(Debug)]
struct Listing {
    client: Client,
    path: String,
    entries: Vec<Vec<u8>>,
    used_us: u64,
}

/// The latest listing of each client.
#[derive(Debug, Default)]
pub struct Listings(Vec<Listing>);

impl Listings {
    /// As many entries from an offset on as fit into `room` bytes. A listing begins at zero: only then, and when it is not kept, the
    /// folder is read.
    pub fn piece(
        &mut self,
        (client, path): (Client, &str),
        from: u32,
        room: usize,
        time_us: u64,
        read: impl FnOnce() -> Result<Vec<Vec<u8>>, Nak>,
    ) -> Result<Vec<u8>, Nak> {
        let place = self.0.iter().position(|kept| kept.client == client);
        let mut kept = place
            .map(|place| self.0.remove(place))
            .filter(|kept| from > 0 && kept.path == path && time_us.saturating_sub(kept.used_us) < IDLE_US);
        let listing = match kept.take() {
            Some(kept) => Listing { used_us: time_us, ..kept },
            None => Listing { client, path: path.to_owned(), entries: read()?, used_us: time_us },
        };
        let piece = piece(listing.entries.get(from as usize..).unwrap_or_default(), room);
        if self.0.len() >= MOST {
            self.0.remove(0);
        }
        self.0.push(listing);
        piece
    }

    /// Forgets the listing of a client.
    pub fn forget(&mut self, client: Client) {
        self.0.retain(|kept| kept.client != client);
    }
}

/// As many entries as fit.
pub fn piece(entries: &[Vec<u8>], room: usize) -> Result<Vec<u8>, Nak> {
    if entries.is_empty() {
        return Err(Nak::EndOfFile);
    }
    let mut data = Vec::new();
    for entry in entries {
        if data.len() + entry.len() > room {
            break;
        }
        data.extend_from_slice(entry);
    }
    Ok(data)
}
