//! The program's end: an FMU in another process, as far as this one sees it.

use std::collections::VecDeque;
use std::io;
use std::path::{Path, PathBuf};
use std::process::{Child, ChildStdin, ChildStdout, Command, Stdio};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant};

use super::frame;
use super::guest_error::{Cause, GuestError};
use super::lines::{Listener, Said};
use super::protocol::{Request, Response, Start, StartValue};
use super::signal_names::signal;
use super::slip::Slip;
use super::watchdog::Watchdog;
use crate::error::ImportError;
use crate::fmi2::Status;
use crate::fmu::Fmu;

/// A host whose pipe is closed has ended, or does so within this time.
const PARTING: Duration = Duration::from_secs(2);
/// What was said last is told with a failure: so many lines, each at most so many characters.
const LAST_WORDS: usize = 3;
const LONGEST_WORDS: usize = 600;

/// What a guarded instance is made from.
#[derive(Clone, Debug, PartialEq)]
pub struct Setup {
    /// Name of the instance.
    pub name: String,
    /// The program that calls [`host`](super::host) when it is started with these arguments.
    pub host: (PathBuf, Vec<String>),
    /// Libraries that are loaded before it, for all to see.
    pub preload: Vec<PathBuf>,
    /// Whether its logger tells more than warnings and errors.
    pub debug: bool,
    /// Start values of parameters and others, set before the initialization.
    pub values: Vec<(u32, StartValue)>,
    /// Real inputs of each step, with their values in the initialization.
    pub reals: Vec<(u32, f64)>,
    /// Boolean inputs of each step, with their values in the initialization.
    pub booleans: Vec<(u32, bool)>,
    /// Real variables to read after each step.
    pub outputs: Vec<u32>,
    /// Longest time of loading and initializing.
    pub longest_start: Duration,
    /// Longest time of a step, and of the end.
    pub longest_step: Duration,
}

/// An FMU's instance in a process of its own. It ends with the value.
#[derive(Debug)]
pub struct Guarded {
    name: String,
    child: Arc<Mutex<Child>>,
    requests: ChildStdin,
    responses: ChildStdout,
    listener: Listener,
    watchdog: Watchdog,
    slip: PathBuf,
    longest_step: Duration,
    last_words: VecDeque<String>,
    /// What was said while it failed, to be taken after.
    said: Vec<Said>,
    /// Its files.
    _fmu: Fmu,
}

impl Guarded {
    /// Starts a process, and an initialized instance in it. Returns the outputs at the start, too.
    ///
    /// # Errors
    /// [`GuestError`]; a missing library is an [`ImportError`] already of [`Fmu::library`].
    pub fn start(fmu: Fmu, setup: &Setup) -> Result<(Self, Vec<f64>), GuestError> {
        let name = fmu.description().model_name.clone();
        let not_started = |why: String| GuestError {
            name: name.clone(),
            cause: Cause::NotStarted(why),
            last_words: Vec::new(),
        };
        let library = fmu.library().map_err(|error: ImportError| not_started(error.to_string()))?;
        let library_folder = library.parent().map(Path::to_owned).unwrap_or_default();
        let slip = fmu.folder().join(".call");
        let start = Start {
            preload: setup.preload.clone(),
            library,
            guid: fmu.description().guid.clone(),
            resources: fmu.resources(),
            name: setup.name.clone(),
            debug: setup.debug,
            slip: slip.clone(),
            values: setup.values.clone(),
            reals: setup.reals.clone(),
            booleans: setup.booleans.clone(),
            outputs: setup.outputs.clone(),
        };
        let mut child =
            spawn(&setup.host, &library_folder).map_err(|error| not_started(error.to_string()))?;
        let pipes = (child.stdin.take(), child.stdout.take(), child.stderr.take());
        let (Some(requests), Some(responses), Some(said)) = pipes else {
            return Err(not_started("its pipes are missing".to_owned()));
        };
        let child = Arc::new(Mutex::new(child));
        let watched = Arc::clone(&child);
        let mut guarded = Self {
            name,
            child,
            requests,
            responses,
            listener: Listener::new(said),
            watchdog: Watchdog::new(move || end(&mut watched.lock().unwrap_or_else(PoisonError::into_inner))),
            slip,
            longest_step: setup.longest_step,
            last_words: VecDeque::new(),
            said: Vec::new(),
            _fmu: fmu,
        };
        let values = guarded.values(&Request::Start(Box::new(start)), setup.longest_start)?;
        Ok((guarded, values))
    }

    /// Name of the model.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Sets the inputs, simulates from one time, s, on by a step, s, and returns the outputs after it.
    ///
    /// # Errors
    /// [`GuestError`]; nothing can follow it.
    pub fn step(
        &mut self,
        time_s: f64,
        step_s: f64,
        reals: &[f64],
        booleans: &[bool],
    ) -> Result<Vec<f64>, GuestError> {
        let (reals, booleans) = (reals.to_vec(), booleans.to_vec());
        self.values(&Request::Step { time_s, step_s, reals, booleans }, self.longest_step)
    }

    /// Terminates the instance and ends its process.
    ///
    /// # Errors
    /// [`GuestError`] of the end.
    pub fn finish(&mut self) -> Result<(), GuestError> {
        match self.ask(&Request::Finish, self.longest_step)? {
            Response::Finished => {
                self.listener.wait_for_mark(PARTING);
                Ok(())
            }
            Response::Failed(what) => Err(self.error(Cause::Failed(what))),
            Response::Values(_) => Err(self.error(Cause::Babbled("values".to_owned()))),
        }
    }

    /// What it has said since the last call.
    pub fn take_said(&mut self) -> Vec<Said> {
        self.hear();
        std::mem::take(&mut self.said)
    }

    fn values(&mut self, request: &Request, within: Duration) -> Result<Vec<f64>, GuestError> {
        match self.ask(request, within)? {
            Response::Values(values) => Ok(values),
            Response::Failed(what) => Err(self.error(Cause::Failed(what))),
            Response::Finished => Err(self.error(Cause::Babbled("an end".to_owned()))),
        }
    }

    /// A request and its response, in time.
    fn ask(&mut self, request: &Request, within: Duration) -> Result<Response, GuestError> {
        self.watchdog.arm(within);
        let response = frame::write(&mut self.requests, request)
            .and_then(|()| frame::read::<Response>(&mut self.responses));
        let late = self.watchdog.disarm();
        match response {
            Ok(Some(response)) if !late => Ok(response),
            Err(error) if error.kind() == io::ErrorKind::InvalidData => {
                Err(self.error(Cause::Babbled(error.to_string())))
            }
            _ => {
                let cause = self.cause_of_end(late.then_some(within));
                Err(self.error(cause))
            }
        }
    }

    /// How the process ended.
    fn cause_of_end(&self, late: Option<Duration>) -> Cause {
        let call = Slip::read(&self.slip);
        let status = wait(&self.child, PARTING);
        if let Some(within) = late {
            return Cause::Hung(call, within);
        }
        match status.and_then(|status| signal(status).map(|how| (status, Some(how))).or(Some((status, None))))
        {
            Some((_, Some(how))) => Cause::Crashed(call, how),
            Some((status, None)) => Cause::Exited(call, status.code()),
            None => Cause::Exited(call, None),
        }
    }

    /// An error with what was said last.
    fn error(&mut self, cause: Cause) -> GuestError {
        match cause {
            Cause::Failed(_) => self.listener.wait_for_mark(PARTING),
            _ => self.listener.wait(PARTING),
        }
        self.hear();
        GuestError { name: self.name.clone(), cause, last_words: self.last_words.iter().cloned().collect() }
    }

    /// Takes in what has been said.
    fn hear(&mut self) {
        for said in self.listener.take() {
            let words = match &said {
                Said::Message(message) if message.status != Status::Ok => Some(&message.text),
                Said::Printed(line) => Some(line),
                _ => None,
            };
            if let Some(words) = words {
                let line = words.lines().collect::<Vec<_>>().join(" ");
                self.last_words.push_back(shortened(&line, LONGEST_WORDS));
                if self.last_words.len() > LAST_WORDS {
                    self.last_words.pop_front();
                }
            }
            self.said.push(said);
        }
    }
}

/// A line of at most so many characters; what is left out of a longer one begins after a whole word, and shows as "…".
fn shortened(line: &str, longest: usize) -> String {
    if line.chars().count() <= longest {
        return line.to_owned();
    }
    let beginning: String = line.chars().take(longest.saturating_sub(2)).collect();
    let whole = beginning.rsplit_once(' ').map_or(beginning.as_str(), |(whole, _)| whole);
    format!("{whole} …")
}

impl Drop for Guarded {
    fn drop(&mut self) {
        let mut child = self.child.lock().unwrap_or_else(PoisonError::into_inner);
        end(&mut child);
        let _status = child.wait();
    }
}

/// Where the system looks for libraries that a library needs.
const SEARCHED: &str = if cfg!(windows) {
    "PATH"
} else if cfg!(target_os = "macos") {
    "DYLD_LIBRARY_PATH"
} else {
    "LD_LIBRARY_PATH"
};

/// Starts the host. Libraries that an FMU brings along are found beside its own, whatever that says of where to look.
fn spawn((program, arguments): &(PathBuf, Vec<String>), library_folder: &Path) -> io::Result<Child> {
    let usual = std::env::var_os(SEARCHED).unwrap_or_default();
    let folders = std::iter::once(library_folder.to_owned()).chain(std::env::split_paths(&usual));
    let searched = std::env::join_paths(folders.filter(|folder| !folder.as_os_str().is_empty()));
    let mut command = Command::new(program);
    // No list has room for a folder whose name has the separator in it; an FMU that needs nothing beside it starts without.
    if let Ok(searched) = searched {
        command.env(SEARCHED, searched);
    }
    command.args(arguments).stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped());
    // An interrupt at the terminal is for us: the flight ends, then the FMU.
    #[cfg(unix)]
    std::os::unix::process::CommandExt::process_group(&mut command, 0);
    #[cfg(windows)]
    {
        const CREATE_NEW_PROCESS_GROUP: u32 = 0x200;
        std::os::windows::process::CommandExt::creation_flags(&mut command, CREATE_NEW_PROCESS_GROUP);
    }
    command.spawn()
}

/// Waits for the end of a process for a while, then ends it. `None` if it had to be.
fn wait(child: &Mutex<Child>, longest: Duration) -> Option<std::process::ExitStatus> {
    let start = Instant::now();
    let mut child = child.lock().unwrap_or_else(PoisonError::into_inner);
    while start.elapsed() < longest {
        if let Ok(Some(status)) = child.try_wait() {
            return Some(status);
        }
        std::thread::sleep(Duration::from_millis(1));
    }
    end(&mut child);
    let _status = child.wait();
    None
}

/// Ends a process, and those that it has started.
fn end(child: &mut Child) {
    #[cfg(unix)]
    if let (Ok(None), Ok(group)) = (child.try_wait(), i32::try_from(child.id())) {
        // SAFETY: the child still has its number, which is that of its group, too.
        unsafe { libc::kill(-group, libc::SIGKILL) };
    }
    let _gone = child.kill();
}

#[cfg(test)]
mod tests {
    use super::shortened;

    #[test]
    fn long_lines_end_with_a_whole_word() {
        assert_eq!(shortened("no root found", 13), "no root found");
        assert_eq!(shortened("no root found at all", 13), "no root …");
        assert_eq!(shortened(&"ü".repeat(30), 10), format!("{} …", "ü".repeat(8)));
    }
}
