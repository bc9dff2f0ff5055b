//! How the program makes a film of a record that the page cannot read by itself.

use std::fmt;
use std::sync::Arc;

use axum::body::Bytes;
use tokio::sync::Semaphore;

/// What flies a record again: its bytes become those of a [`Film`](crate::Film), or the reason why they do not.
type Replay = dyn Fn(&[u8]) -> Result<Vec<u8>, String> + Send + Sync;

/// Flies records again for the page, one at a time: each takes a core.
#[derive(Clone)]
pub struct Replayer {
    replay: Arc<Replay>,
    free: Arc<Semaphore>,
}

/// Why there is no film.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum NoFilm {
    /// Another record is being replayed.
    Busy,
    /// What is wrong with the record.
    Refused(String),
}

impl Replayer {
    /// By a function, which is called on a thread of its own.
    pub fn new(replay: impl Fn(&[u8]) -> Result<Vec<u8>, String> + Send + Sync + 'static) -> Self {
        Self { replay: Arc::new(replay), free: Arc::new(Semaphore::new(1)) }
    }

    /// The film of a record, which is received only if it is its turn.
    pub(crate) async fn film(
        &self,
        record: impl Future<Output = Result<Bytes, NoFilm>>,
    ) -> Result<Vec<u8>, NoFilm> {
        let turn = Arc::clone(&self.free).try_acquire_owned().map_err(|_| NoFilm::Busy)?;
        let record = record.await?;
        let replay = Arc::clone(&self.replay);
        let replayed = tokio::task::spawn_blocking(move || {
            // A browser that leaves does not end the replay.
            let _turn = turn;
            replay(&record)
        });
        match replayed.await {
            Ok(film) => film.map_err(NoFilm::Refused),
            Err(_panicked) => {
                Err(NoFilm::Refused("the replay has failed; report it, with the record".to_owned()))
            }
        }
    }
}

impl fmt::Debug for Replayer {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.debug_struct("Replayer").finish_non_exhaustive()
    }
}
