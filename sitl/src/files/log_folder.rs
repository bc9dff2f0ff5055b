//! The folder of logs: numbers that only grow, and no more files than wanted.

use std::collections::BTreeSet;
use std::fs::{File, OpenOptions};
use std::io;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError};

use autopilot::file_store::LAST_LOG;

use crate::failure::Failure;

const PREFIX: &str = "flight_";
const SUFFIX: &str = ".ulg";
/// ArduPilot's names are the number alone.
const NUMBERED_SUFFIX: &str = ".BIN";
const NUMBERED_DIGITS: usize = 8;
/// Files that may get the next number before it is this program's.
const MOST_TAKEN: u32 = 1000;

/// Logs that are removed where a new one begins.
const MOST_AT_ONCE: usize = 8;

#[derive(Debug, Default)]
struct State {
    next: u32,
    /// Names of logs that are being written.
    current: BTreeSet<String>,
}

/// A folder of logs; copies are the same folder.
#[derive(Clone, Debug)]
pub struct LogFolder {
    path: PathBuf,
    state: Arc<Mutex<State>>,
}

/// The number of a log: `flight_00042_id1.ulg` is the 42nd, and so is `00000042.BIN`.
fn number(name: &str) -> Option<u32> {
    if let Some(digits) = name.strip_suffix(NUMBERED_SUFFIX) {
        return digits.parse().ok().filter(|_| digits.len() == NUMBERED_DIGITS);
    }
    let (number, id) = name.strip_prefix(PREFIX)?.strip_suffix(SUFFIX)?.split_once("_id")?;
    id.parse::<u8>().ok()?;
    number.parse().ok()
}

impl LogFolder {
    /// Opens a folder; makes it if it is not there.
    ///
    /// # Errors
    /// [`Failure::File`]
    pub fn open(path: &Path) -> Result<Self, Failure> {
        std::fs::create_dir_all(path).map_err(|source| Failure::write(path, source))?;
        let folder = Self { path: path.to_owned(), state: Arc::default() };
        let names = folder.names().map_err(|source| Failure::read(path, source))?;
        let last = names.iter().filter_map(|name| number(name)).max().unwrap_or(0);
        folder.with(|state| state.next = last.saturating_add(1));
        Ok(folder)
    }

    /// Where it is.
    pub fn path(&self) -> &Path {
        &self.path
    }

    fn with<T>(&self, work: impl FnOnce(&mut State) -> T) -> T {
        // Whoever has panicked with it has left names and a number, which are as good as before.
        work(&mut self.state.lock().unwrap_or_else(PoisonError::into_inner))
    }

    fn names(&self) -> io::Result<Vec<String>> {
        let entries = std::fs::read_dir(&self.path)?;
        Ok(entries.flatten().filter_map(|entry| entry.file_name().into_string().ok()).collect())
    }

    /// Begins a log of a vehicle, after removing the oldest ones beyond `most` with it.
    ///
    /// # Errors
    /// When there is no place for it.
    pub fn create(&self, system_id: u8, most: usize) -> io::Result<(String, File)> {
        self.create_named(most, |number| format!("{PREFIX}{number:05}_id{system_id}{SUFFIX}"))
    }

    /// The same with one of ArduPilot's names; its number is the content of LASTLOG.TXT.
    ///
    /// # Errors
    /// When there is no place for it.
    pub fn create_numbered(&self, most: usize) -> io::Result<(String, File)> {
        let (name, file) = self.create_named(most, |number| format!("{number:08}{NUMBERED_SUFFIX}"))?;
        let last = number(&name).unwrap_or(0);
        if let Err(error) = std::fs::write(self.path.join(LAST_LOG), format!("{last}\r\n")) {
            tracing::warn!("{LAST_LOG} not written: {error}");
        }
        Ok((name, file))
    }

    fn create_named(&self, most: usize, named: impl Fn(u32) -> String) -> io::Result<(String, File)> {
        self.with(|state| {
            let mut logs: Vec<(u32, String)> =
                self.names()?.into_iter().filter_map(|name| Some((number(&name)?, name))).collect();
            logs.sort();
            let surplus = (logs.len() + 1).saturating_sub(most.max(1));
            let over = logs.iter().filter(|(_, name)| !state.current.contains(name));
            remove(over.take(surplus).map(|(_, name)| self.path.join(name)).collect())?;
            for _ in 0..MOST_TAKEN {
                let name = named(state.next);
                state.next = state.next.saturating_add(1);
                match OpenOptions::new().write(true).create_new(true).open(self.path.join(&name)) {
                    Ok(file) => {
                        state.current.insert(name.clone());
                        return Ok((name, file));
                    }
                    // Another program logs into the same folder.
                    Err(error) if error.kind() == io::ErrorKind::AlreadyExists => {}
                    Err(error) => return Err(error),
                }
            }
            Err(io::Error::new(io::ErrorKind::AlreadyExists, "no number is free"))
        })
    }

    /// A log is complete.
    pub fn finish(&self, name: &str) {
        self.with(|state| state.current.remove(name));
    }

    /// Whether a name is that of a log that is complete.
    pub fn is_over(&self, name: &str) -> bool {
        number(name).is_some() && !self.with(|state| state.current.contains(name))
    }
}

/// Removes files: a few at once, many in a thread of their own, because a vehicle is about to fly.
fn remove(mut paths: Vec<PathBuf>) -> io::Result<()> {
    let later = paths.split_off(paths.len().min(MOST_AT_ONCE));
    paths.iter().try_for_each(std::fs::remove_file)?;
    if later.is_empty() {
        return Ok(());
    }
    let work = move || {
        if let Some(error) = later.iter().find_map(|path| std::fs::remove_file(path).err()) {
            tracing::warn!("old flight logs not removed: {error}");
        }
    };
    std::thread::Builder::new().name("old logs".to_owned()).spawn(work).map(drop)
}

#[cfg(test)]
mod tests {
    use super::LogFolder;

    #[test]
    fn numbers_grow_and_the_oldest_go_but_nothing_else() {
        let place = tempfile::tempdir().expect("a folder");
        let path = place.path().join("new/logs");
        let names = || {
            let entries = std::fs::read_dir(&path).expect("a folder");
            let mut names: Vec<String> = entries
                .map(|entry| entry.expect("an entry").file_name().into_string().expect("text"))
                .collect();
            names.sort();
            names
        };
        let folder = LogFolder::open(&path).expect("made");
        for other in ["flight_00001.ulg", "flight_x_id1.ulg", "flight_00001_id999.ulg", "notes.txt"] {
            std::fs::write(path.join(other), "mine").expect("written");
        }
        let others = names();
        for _ in 0..5 {
            let (name, _) = folder.create(1, 3).expect("a log");
            folder.finish(&name);
        }
        let logs: Vec<String> = names().into_iter().filter(|name| !others.contains(name)).collect();
        assert_eq!(logs, ["flight_00003_id1.ulg", "flight_00004_id1.ulg", "flight_00005_id1.ulg"]);
        assert_eq!(names().len(), others.len() + 3);
        // One that is being written stays, and a number is never used again.
        let folder = LogFolder::open(&path).expect("there");
        let (first, _) = folder.create(2, 2).expect("a log");
        let (second, _) = folder.create(3, 1).expect("a log");
        assert_eq!((first.as_str(), second.as_str()), ("flight_00006_id2.ulg", "flight_00007_id3.ulg"));
        assert!(names().contains(&first) && !folder.is_over(&first) && !folder.is_over("notes.txt"));
        folder.finish(&first);
        assert!(folder.is_over(&first));
    }
}
