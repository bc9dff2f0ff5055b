//! A listener that keeps no more connections open than the program can spare: links, logs and records need descriptors, too.
//! Browsers open connections in advance and keep them for minutes: on which nothing comes and goes is closed.

use std::io::{self, IoSlice};
use std::net::SocketAddr;
use std::pin::Pin;
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::task::{Context, Poll};
use std::time::Duration;

use axum::extract::connect_info::Connected;
use axum::serve::{IncomingStream, Listener};
use tokio::io::{AsyncRead, AsyncWrite, ReadBuf};
use tokio::net::{TcpListener, TcpStream};
use tokio::sync::{OwnedSemaphorePermit, Semaphore};
use tokio::time::{Instant, Sleep, sleep};

/// Connections at once: each browser has one that stays, and some more while it loads the page.
pub const MOST_CONNECTIONS: usize = 128;

/// Closes at once what is too many.
#[derive(Debug)]
pub struct BoundedListener {
    listener: TcpListener,
    free: Arc<Semaphore>,
    idle: Duration,
}

impl BoundedListener {
    /// Connections may be silent for as long as `idle`.
    pub fn new(listener: TcpListener, idle: Duration) -> Self {
        Self { listener, free: Arc::new(Semaphore::new(MOST_CONNECTIONS)), idle }
    }
}

impl Listener for BoundedListener {
    type Io = Counted;
    type Addr = SocketAddr;

    async fn accept(&mut self) -> (Counted, SocketAddr) {
        loop {
            let (stream, address) = Listener::accept(&mut self.listener).await;
            if let Ok(place) = Arc::clone(&self.free).try_acquire_owned() {
                return (Counted::new(stream, place, self.idle), address);
            }
        }
    }

    fn local_addr(&self) -> io::Result<SocketAddr> {
        self.listener.local_addr()
    }
}

/// What is being done on a connection that may be silent meanwhile: answers that take long, and streams.
#[derive(Clone, Debug, Default)]
pub struct Work(Arc<AtomicUsize>);

impl Work {
    /// Something begins, and ends when the value is dropped.
    pub fn begin(self) -> Working {
        self.0.fetch_add(1, Ordering::Relaxed);
        Working(self)
    }

    fn is_done(&self) -> bool {
        self.0.load(Ordering::Relaxed) == 0
    }
}

impl Connected<IncomingStream<'_, BoundedListener>> for Work {
    fn connect_info(stream: IncomingStream<'_, BoundedListener>) -> Self {
        stream.io().work.clone()
    }
}

/// One thing that is being done.
#[derive(Debug)]
pub struct Working(Work);

impl Drop for Working {
    fn drop(&mut self) {
        self.0.0.fetch_sub(1, Ordering::Relaxed);
    }
}

/// A connection, which counts until it ends.
#[derive(Debug)]
pub struct Counted {
    stream: TcpStream,
    _place: OwnedSemaphorePermit,
    work: Work,
    /// When something came or went last, and for how long nothing may.
    used: Instant,
    idle: Duration,
    alarm: Pin<Box<Sleep>>,
}

impl Counted {
    fn new(stream: TcpStream, place: OwnedSemaphorePermit, idle: Duration) -> Self {
        let alarm = Box::pin(sleep(idle));
        Self { stream, _place: place, work: Work::default(), used: Instant::now(), idle, alarm }
    }

    /// Takes in how a read or a write has ended.
    fn mark<T>(&mut self, outcome: Poll<io::Result<T>>) -> Poll<io::Result<T>> {
        if matches!(outcome, Poll::Ready(Ok(_))) {
            self.used = Instant::now();
        }
        outcome
    }

    /// An error when the connection has been silent for too long.
    fn poll_silence(&mut self, context: &mut Context<'_>) -> Poll<io::Error> {
        while self.alarm.as_mut().poll(context).is_ready() {
            let end = self.used + self.idle;
            let now = Instant::now();
            if end <= now && self.work.is_done() {
                return Poll::Ready(io::ErrorKind::TimedOut.into());
            }
            self.alarm.as_mut().reset(if end > now { end } else { now + self.idle });
        }
        Poll::Pending
    }
}

impl AsyncRead for Counted {
    fn poll_read(
        mut self: Pin<&mut Self>,
        context: &mut Context<'_>,
        buffer: &mut ReadBuf<'_>,
    ) -> Poll<io::Result<()>> {
        let outcome = Pin::new(&mut self.stream).poll_read(context, buffer);
        match self.mark(outcome) {
            // Whoever serves a connection always waits for its next bytes, too.
            Poll::Pending => self.poll_silence(context).map(Err),
            ready => ready,
        }
    }
}

impl AsyncWrite for Counted {
    fn poll_write(
        mut self: Pin<&mut Self>,
        context: &mut Context<'_>,
        bytes: &[u8],
    ) -> Poll<io::Result<usize>> {
        let outcome = Pin::new(&mut self.stream).poll_write(context, bytes);
        self.mark(outcome)
    }

    fn poll_flush(mut self: Pin<&mut Self>, context: &mut Context<'_>) -> Poll<io::Result<()>> {
        Pin::new(&mut self.stream).poll_flush(context)
    }

    fn poll_shutdown(mut self: Pin<&mut Self>, context: &mut Context<'_>) -> Poll<io::Result<()>> {
        Pin::new(&mut self.stream).poll_shutdown(context)
    }

    fn poll_write_vectored(
        mut self: Pin<&mut Self>,
        context: &mut Context<'_>,
        pieces: &[IoSlice<'_>],
    ) -> Poll<io::Result<usize>> {
        let outcome = Pin::new(&mut self.stream).poll_write_vectored(context, pieces);
        self.mark(outcome)
    }

    fn is_write_vectored(&self) -> bool {
        self.stream.is_write_vectored()
    }
}

#[cfg(test)]
mod tests {
    use std::io::{Read, Write};
    use std::net::TcpStream;
    use std::time::Duration;

    use axum::Router;
    use axum::extract::ConnectInfo;
    use axum::routing::get;

    use super::{BoundedListener, MOST_CONNECTIONS, Work};
    use crate::{Past, Viewer};

    /// Whether the page is served over a connection.
    fn is_served(mut stream: &TcpStream) -> bool {
        let request = b"GET / HTTP/1.1\r\nHost: localhost\r\n\r\n";
        let mut beginning = [0; 12];
        stream.set_read_timeout(Some(Duration::from_secs(10))).expect("a timeout");
        stream.write_all(request).is_ok()
            && stream.read_exact(&mut beginning).is_ok()
            && &beginning == b"HTTP/1.1 200"
    }

    #[test]
    fn what_is_too_much_is_closed_and_what_ends_makes_room() {
        let viewer = Viewer::open("127.0.0.1", 0, Past::default()).expect("a free port");
        let connect = || TcpStream::connect(viewer.address()).expect("it listens");
        let all: Vec<TcpStream> = (0..MOST_CONNECTIONS).map(|_| connect()).collect();
        // Connections are accepted in their order.
        assert!(is_served(&all[MOST_CONNECTIONS - 1]));
        assert!(!is_served(&connect()));
        drop(all);
        // It takes a moment until all ends are seen.
        assert!((0..1000).any(|_| is_served(&connect())), "no room");
    }

    /// Serves in the background until the test ends: `/` at once, `/long` after many times the longest silence.
    fn serve(idle: Duration) -> std::net::SocketAddr {
        let runtime = tokio::runtime::Builder::new_current_thread().enable_all().build().expect("a runtime");
        let listener = runtime.block_on(tokio::net::TcpListener::bind("127.0.0.1:0")).expect("a free port");
        let address = listener.local_addr().expect("an address");
        let long = async move |ConnectInfo(work): ConnectInfo<Work>| {
            let _lasting = work.begin();
            tokio::time::sleep(20 * idle).await;
        };
        let service = Router::new().route("/", get(async || ())).route("/long", get(long));
        let listener = BoundedListener::new(listener, idle);
        let serving =
            async { axum::serve(listener, service.into_make_service_with_connect_info::<Work>()).await };
        std::thread::spawn(move || runtime.block_on(serving));
        address
    }

    #[test]
    fn silent_connections_end_and_those_with_work_do_not() {
        let address = serve(Duration::from_millis(50));
        let connect = || {
            let stream = TcpStream::connect(address).expect("it listens");
            stream.set_read_timeout(Some(Duration::from_secs(10))).expect("a timeout");
            stream
        };
        let mut busy = connect();
        busy.write_all(b"GET /long HTTP/1.1\r\nHost: localhost\r\n\r\n").expect("sent");
        let mut unused: Vec<TcpStream> = (0..2 * MOST_CONNECTIONS).map(|_| connect()).collect();
        let used = connect();
        for mut stream in unused.drain(..).chain([used]) {
            // An end, not the timeout of this test.
            let end = stream.read(&mut [0]);
            let is_closed = matches!(&end, Ok(0))
                || end.is_err_and(|error| error.kind() == std::io::ErrorKind::ConnectionReset);
            assert!(is_closed, "a silent connection stays");
        }
        assert!(is_served(&connect()), "no room");
        let mut beginning = [0; 12];
        busy.read_exact(&mut beginning).expect("an answer");
        assert_eq!(&beginning, b"HTTP/1.1 200");
    }
}
