//! A thread that works on files, so that no disk holds a flight up.

use std::collections::{BTreeMap, VecDeque};
use std::fmt;
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};

use autopilot::envelope::PeerId;
use autopilot::file_store::FileStore;
use autopilot::file_work::{FileJob, FileWorker, JobStep, QueueFull};

/// Jobs of one client that wait.
const MOST_OF_ONE: usize = 64;
/// And of all of them.
const MOST: usize = 1024;

/// Number of a vehicle, and one of its clients.
type Client = (usize, PeerId);

/// The work of all vehicles on one store. The thread begins with the first job, and is left to itself when the last desk is dropped: a
/// disk that does not answer keeps neither a flight nor the end of the program waiting.
#[derive(Debug)]
pub struct FileThread {
    shared: Arc<Shared>,
}

/// One vehicle's way to the thread.
#[derive(Debug)]
struct Desk {
    shared: Arc<Shared>,
    vehicle: usize,
}

#[derive(Debug)]
struct Shared {
    queues: Mutex<Queues>,
    news: Condvar,
}

/// What is to be done, by client.
struct Queues {
    /// The store, until the thread begins.
    store: Option<Box<dyn FileStore>>,
    waiting: BTreeMap<Client, VecDeque<Box<dyn FileJob>>>,
    /// Who was served last.
    last: Option<Client>,
    closed: bool,
}

impl fmt::Debug for Queues {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.debug_struct("Queues").field("waiting", &self.count()).finish_non_exhaustive()
    }
}

impl FileThread {
    /// Works on a store from now on.
    pub fn new(store: impl FileStore + 'static) -> Self {
        let queues =
            Queues { store: Some(Box::new(store)), waiting: BTreeMap::new(), last: None, closed: false };
        Self { shared: Arc::new(Shared { queues: Mutex::new(queues), news: Condvar::new() }) }
    }

    /// The way of a vehicle to the store.
    pub fn desk(&self, vehicle: usize) -> Box<dyn FileWorker> {
        Box::new(Desk { shared: Arc::clone(&self.shared), vehicle })
    }
}

impl Drop for FileThread {
    fn drop(&mut self) {
        let mut queues = self.shared.lock();
        queues.closed = true;
        queues.waiting.clear();
        self.shared.news.notify_one();
    }
}

impl FileWorker for Desk {
    fn submit(&mut self, client: PeerId, job: Box<dyn FileJob>) -> Result<(), QueueFull> {
        let client = (self.vehicle, client);
        let mut queues = self.shared.lock();
        let own = queues.waiting.get(&client).map_or(0, VecDeque::len);
        if queues.closed || own >= MOST_OF_ONE || queues.count() >= MOST {
            return Err(QueueFull);
        }
        if let Some(store) = queues.store.take()
            && let Err(error) = begin(&self.shared, store)
        {
            tracing::warn!("clients cannot reach files: {error}");
            queues.closed = true;
            return Err(QueueFull);
        }
        queues.waiting.entry(client).or_default().push_back(job);
        self.shared.news.notify_one();
        Ok(())
    }
}

fn begin(shared: &Arc<Shared>, mut store: Box<dyn FileStore>) -> std::io::Result<()> {
    let shared = Arc::clone(shared);
    let work = move || {
        while let Some((client, mut job)) = shared.next() {
            if job.advance(store.as_mut()) == JobStep::More {
                shared.put_back(client, job);
            }
        }
    };
    std::thread::Builder::new().name("files".to_owned()).spawn(work).map(drop)
}

impl Shared {
    fn lock(&self) -> MutexGuard<'_, Queues> {
        // Nothing panics while it has the queues.
        self.queues.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Waits for a job; `None`: there will be none any more.
    fn next(&self) -> Option<(Client, Box<dyn FileJob>)> {
        let mut queues = self.lock();
        loop {
            if queues.closed {
                return None;
            }
            if let Some(found) = queues.take() {
                return Some(found);
            }
            queues = self.news.wait(queues).unwrap_or_else(PoisonError::into_inner);
        }
    }

    fn put_back(&self, client: Client, job: Box<dyn FileJob>) {
        let mut queues = self.lock();
        if !queues.closed {
            queues.waiting.entry(client).or_default().push_front(job);
        }
    }
}

impl Queues {
    fn count(&self) -> usize {
        self.waiting.values().map(VecDeque::len).sum()
    }

    /// The first job of the client whose turn it is.
    fn take(&mut self) -> Option<(Client, Box<dyn FileJob>)> {
        let clients = || self.waiting.keys().copied();
        let later = clients().find(|client| self.last.is_none_or(|last| *client > last));
        let client = later.or_else(|| clients().next())?;
        self.last = Some(client);
        let queue = self.waiting.get_mut(&client)?;
        let job = queue.pop_front()?;
        if queue.is_empty() {
            self.waiting.remove(&client);
        }
        Some((client, job))
    }
}

#[cfg(test)]
mod tests {
    use std::sync::mpsc::{Receiver, Sender, channel};
    use std::time::Duration;

    use autopilot::envelope::PeerId;
    use autopilot::file_store::{FileStore, Nothing};
    use autopilot::file_work::{FileJob, JobStep, QueueFull};

    use super::{FileThread, MOST_OF_ONE};

    /// Tells its name at each of its steps.
    #[derive(Debug)]
    struct Steps(&'static str, usize, Sender<&'static str>);

    impl FileJob for Steps {
        fn advance(&mut self, _store: &mut dyn FileStore) -> JobStep {
            self.2.send(self.0).expect("the test listens");
            self.1 -= 1;
            if self.1 == 0 { JobStep::Done } else { JobStep::More }
        }
    }

    /// Does not end before it is told to.
    #[derive(Debug)]
    struct Hanging(Sender<()>, Receiver<()>);

    impl FileJob for Hanging {
        fn advance(&mut self, _store: &mut dyn FileStore) -> JobStep {
            let _gone = self.0.send(());
            let _gone = self.1.recv();
            JobStep::Done
        }
    }

    fn peer(number: u64) -> PeerId {
        PeerId { link: 0, number }
    }

    const LONG: Duration = Duration::from_secs(60);

    #[test]
    fn clients_take_turns_and_each_is_served_in_order() {
        let thread = FileThread::new(Nothing);
        let mut desk = thread.desk(0);
        let (began, has_begun) = channel();
        let (end, ended) = channel();
        desk.submit(peer(9), Box::new(Hanging(began, ended))).expect("room");
        has_begun.recv_timeout(LONG).expect("the thread works");
        let (said, heard) = channel();
        let jobs = [(1, "a", 3), (1, "b", 1), (2, "c", 2), (3, "d", 1)];
        for (client, name, steps) in jobs {
            desk.submit(peer(client), Box::new(Steps(name, steps, said.clone()))).expect("room");
        }
        end.send(()).expect("it waits");
        let order: Vec<_> = (0..7).map(|_| heard.recv_timeout(LONG).expect("a step")).collect();
        assert_eq!(order, ["a", "c", "d", "a", "c", "a", "b"]);
    }

    #[test]
    fn a_disk_that_hangs_costs_a_full_queue_and_nobody_waits_for_it() {
        let thread = FileThread::new(Nothing);
        let mut desk = thread.desk(0);
        let (began, has_begun) = channel();
        let (end, ended) = channel::<()>();
        desk.submit(peer(1), Box::new(Hanging(began, ended))).expect("room");
        has_begun.recv_timeout(LONG).expect("the thread works");
        let (said, heard) = channel();
        let steps = |_| desk.submit(peer(1), Box::new(Steps("x", 1, said.clone())));
        let taken: Vec<_> = (0..=MOST_OF_ONE).map(steps).collect();
        assert_eq!(taken.iter().filter(|taken| taken.is_ok()).count(), MOST_OF_ONE);
        assert_eq!(taken.last(), Some(&Err(QueueFull)));
        desk.submit(peer(2), Box::new(Steps("y", 1, said.clone())))
            .expect("another client has its own queue");
        // Dropping it returns while the job still hangs; what waits is dropped.
        drop(thread);
        assert_eq!(desk.submit(peer(3), Box::new(Steps("z", 1, said.clone()))), Err(QueueFull));
        drop(said);
        drop(end);
        assert!(heard.recv_timeout(LONG).is_err());
    }
}
