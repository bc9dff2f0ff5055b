//! The host: the child process in which an FMU runs.

use std::io::{self, Write};
use std::path::Path;
use std::process::exit;
use std::time::Duration;

use super::frame;
use super::lines::{MARK, line_of};
use super::protocol::{Request, Response, Start, StartValue};
use super::slip::Slip;
use super::streams::Streams;
use crate::error::{CallError, ImportError};
use crate::fmi2::{Birth, Instance, load_for_all};

/// How often the host looks whether the program that started it is still there.
const LOOK: Duration = Duration::from_millis(200);

/// Serves requests on the standard streams until they end; then the process ends. For a program that
/// [`Guarded`](super::Guarded) has started.
pub fn host() -> ! {
    end_with_parent();
    let code = match Streams::take().and_then(serve) {
        Ok(()) => 0,
        Err(error) => {
            let _gone = writeln!(io::stderr(), "the host of an FMU: {error}");
            1
        }
    };
    exit(code)
}

/// A host whose FMU hangs does not see the end of its requests.
#[cfg(unix)]
fn end_with_parent() {
    let parent = std::os::unix::process::parent_id();
    std::thread::spawn(move || {
        while std::os::unix::process::parent_id() == parent {
            std::thread::sleep(LOOK);
        }
        exit(1)
    });
}

#[cfg(not(unix))]
fn end_with_parent() {
    let _interval = LOOK;
}

fn serve(mut streams: Streams) -> io::Result<()> {
    let mut hosted: Option<Hosted> = None;
    while let Some(request) = frame::read(&mut streams.requests)? {
        let response = match (request, &mut hosted) {
            (Request::Start(start), None) => match Hosted::new(&start) {
                Ok((new, values)) => {
                    hosted = Some(new);
                    Response::Values(values)
                }
                Err(what) => Response::Failed(what),
            },
            (Request::Step { time_s, step_s, reals, booleans }, Some(hosted)) => {
                match hosted.step(time_s, step_s, &reals, &booleans) {
                    Ok(values) => Response::Values(values),
                    Err(error) => Response::Failed(error.to_string()),
                }
            }
            (Request::Finish, _) => {
                // What goes wrong here is said by its log, or seen by its end.
                let ended = hosted.take().map_or(Ok(()), |mut hosted| hosted.instance.terminate());
                ended.map_or_else(|error| Response::Failed(error.to_string()), |()| Response::Finished)
            }
            (Request::Start(_) | Request::Step { .. }, _) => Response::Failed("out of order".to_owned()),
        };
        if !matches!(response, Response::Values(_)) {
            let _gone = io::stderr().write_all(MARK.as_bytes());
        }
        frame::write(&mut streams.responses, &response)?;
    }
    Ok(())
}

/// An instance with the variables that go through the pipes.
struct Hosted {
    instance: Instance,
    reals: Vec<u32>,
    booleans: Vec<u32>,
    outputs: Vec<u32>,
}

impl Hosted {
    /// Loads, instantiates and initializes. Returns the outputs at the start, too.
    fn new(start: &Start) -> Result<(Self, Vec<f64>), String> {
        for library in &start.preload {
            load_for_all(library).map_err(|error| format!("preloading {}: {error}", library.display()))?;
        }
        let instance = instance(start).map_err(|error| error.to_string())?;
        let mut hosted = Self {
            instance,
            reals: start.reals.iter().map(|(reference, _)| *reference).collect(),
            booleans: start.booleans.iter().map(|(reference, _)| *reference).collect(),
            outputs: start.outputs.clone(),
        };
        let values = hosted.initialize(start).map_err(|error| error.to_string())?;
        Ok((hosted, values))
    }

    fn initialize(&mut self, start: &Start) -> Result<Vec<f64>, CallError> {
        for (reference, value) in &start.values {
            match value {
                StartValue::Real(value) => self.instance.set_reals(&[*reference], &[*value])?,
                StartValue::Integer(value) => self.instance.set_integers(&[*reference], &[*value])?,
                StartValue::Boolean(value) => self.instance.set_booleans(&[*reference], &[*value])?,
                StartValue::Text(value) => self.instance.set_string(*reference, value)?,
            }
        }
        self.instance.set_up(0.0, None)?;
        self.instance.enter_initialization()?;
        let reals: Vec<f64> = start.reals.iter().map(|(_, value)| *value).collect();
        let booleans: Vec<bool> = start.booleans.iter().map(|(_, value)| *value).collect();
        self.instance.set_reals(&self.reals, &reals)?;
        self.instance.set_booleans(&self.booleans, &booleans)?;
        self.instance.exit_initialization()?;
        self.outputs()
    }

    fn step(
        &mut self,
        time_s: f64,
        step_s: f64,
        reals: &[f64],
        booleans: &[bool],
    ) -> Result<Vec<f64>, CallError> {
        self.instance.set_reals(&self.reals, reals)?;
        self.instance.set_booleans(&self.booleans, booleans)?;
        self.instance.step(time_s, step_s)?;
        self.outputs()
    }

    fn outputs(&mut self) -> Result<Vec<f64>, CallError> {
        let mut values = vec![0.0; self.outputs.len()];
        self.instance.reals(&self.outputs, &mut values)?;
        Ok(values)
    }
}

fn instance(start: &Start) -> Result<Instance, ImportError> {
    let Start { library, guid, resources, name, debug, slip, .. } = start;
    let slip = Slip::create(Path::new(slip))?;
    let birth = Birth { library, guid, resources, name, debug: *debug };
    let say = |message: crate::fmi2::Message| {
        let _gone = io::stderr().write_all(line_of(&message).as_bytes());
    };
    Instance::new(&birth, say, Box::new(move |call| slip.note(call)))
}
