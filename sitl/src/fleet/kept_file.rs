//! A file that something of a vehicle is kept in over restarts: its parameters, its plans.

use std::path::{Path, PathBuf};
use std::time::Instant;

use crate::failure::Failure;
use crate::files::{FileLock, Notice, Readers, Upkeep, replace};

/// Keeps what has changed: at once, or as soon as the disk lets.
#[derive(Debug)]
pub struct KeptFile {
    path: PathBuf,
    /// What is missing from it while it cannot be written.
    lacks: &'static str,
    upkeep: Upkeep,
    /// What the file should hold and does not.
    unsaved: Option<String>,
    _lock: Option<FileLock>,
}

impl KeptFile {
    /// Of parameters, for this process alone.
    ///
    /// # Errors
    /// As [`FileLock::claim`].
    pub fn of_parameters(path: &Path) -> Result<Self, Failure> {
        let lock = FileLock::claim(path)?;
        Ok(Self { _lock: lock, ..Self::new(path, "Parameters", "lacks the latest changes of parameters") })
    }

    /// Of plans, beside the file of parameters, which is this process's already.
    pub fn of_plans(path: &Path) -> Self {
        Self::new(path, "Plans", "lacks the latest plans")
    }

    fn new(path: &Path, name: &'static str, lacks: &'static str) -> Self {
        let upkeep = Upkeep::new(name, path);
        Self { path: path.to_owned(), lacks, upkeep, unsaved: None, _lock: None }
    }

    /// Where it is.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Saves what has changed, or tries again what could not be saved, each second. Returns what to announce.
    pub fn save(&mut self, changed: Option<String>, now: Instant) -> Option<Notice> {
        self.unsaved = changed.or(self.unsaved.take());
        let text = self.unsaved.as_ref()?;
        let notice = self.upkeep.attempt(now, || replace(&self.path, text.as_bytes(), Readers::All));
        if !self.upkeep.is_failing() {
            self.unsaved = None;
        }
        notice
    }

    /// Tries a last time. Returns what is missing from the file, if anything is.
    pub fn finish(&mut self) -> Option<String> {
        let text = self.unsaved.as_ref()?;
        let _told_below = self.upkeep.judge(replace(&self.path, text.as_bytes(), Readers::All));
        self.upkeep.is_failing().then(|| self.upkeep.lacks(self.lacks))
    }
}

#[cfg(test)]
mod tests {
    use std::time::{Duration, Instant};

    use super::KeptFile;

    #[test]
    fn what_cannot_be_saved_is_saved_later_and_the_last_change_counts() {
        let place = tempfile::tempdir().expect("a folder");
        let folder = place.path().join("gone");
        std::fs::create_dir(&folder).expect("a folder");
        let path = folder.join("a.params");
        let mut file = KeptFile::of_parameters(&path).expect("free");
        let start = Instant::now();
        let after = |ms| start + Duration::from_millis(ms);
        assert_eq!(file.save(Some("one".to_owned()), after(0)), None);
        std::fs::remove_dir_all(&folder).expect("removed");
        let (_, text) = file.save(Some("two".to_owned()), after(10)).expect("news");
        assert!(text.starts_with("Parameters not written: ") && text.len() <= 50, "{text}");
        assert_eq!(file.save(Some("three".to_owned()), after(20)), None);
        let lacking = file.finish().expect("not saved");
        assert!(lacking.contains("a.params lacks the latest changes"), "{lacking}");
        std::fs::create_dir(&folder).expect("a folder");
        assert_eq!(file.save(None, after(30)), None, "too early");
        let news = file.save(None, after(5_000)).map(|(_, text)| text);
        assert_eq!(news.as_deref(), Some("Parameters written again"));
        assert_eq!((std::fs::read(&path).expect("there"), file.finish()), (b"three".to_vec(), None));
    }
}
