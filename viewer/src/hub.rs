//! What the simulation's thread and the browsers' tasks share.

use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::mpsc::SyncSender;

use axum::body::Bytes;
use axum::extract::ws::Utf8Bytes;
use tokio::sync::watch;

use crate::order::Order;
use crate::server::Past;
use crate::token::Token;

/// Browsers at once that only look on.
const MOST_WATCHERS: usize = 32;
/// Places that are kept for browsers with the token.
const MOST_PILOTS: usize = 8;

/// What a browser may do.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Rank {
    /// Look on.
    Watcher,
    /// Give orders.
    Pilot,
}

/// The latest of everything that is published, and the way of orders.
#[derive(Debug)]
pub struct Hub {
    /// Host that the server was told to listen on.
    pub host: String,
    pub token: Token,
    pub frames: watch::Sender<Bytes>,
    pub scene: watch::Sender<Utf8Bytes>,
    pub news: watch::Sender<Utf8Bytes>,
    pub orders: SyncSender<Order>,
    pub past: Past,
    watchers: AtomicUsize,
    pilots: AtomicUsize,
}

impl Hub {
    /// Nothing is published yet.
    pub fn new(host: String, token: Token, orders: SyncSender<Order>, past: Past) -> Self {
        Self {
            host,
            token,
            frames: watch::Sender::new(Bytes::new()),
            scene: watch::Sender::new(Utf8Bytes::default()),
            news: watch::Sender::new(Utf8Bytes::default()),
            orders,
            past,
            watchers: AtomicUsize::new(0),
            pilots: AtomicUsize::new(0),
        }
    }

    /// Lets a browser in, while there are not too many of its rank.
    pub fn seat(&self, rank: Rank) -> Option<Seat<'_>> {
        let (seated, most) = match rank {
            Rank::Watcher => (&self.watchers, MOST_WATCHERS),
            Rank::Pilot => (&self.pilots, MOST_PILOTS),
        };
        let taken = |count| (count < most).then_some(count + 1);
        let free = seated.fetch_update(Ordering::Relaxed, Ordering::Relaxed, taken);
        // Only then: a seat that is made frees a place when it is dropped.
        free.is_ok().then(|| Seat { rank, seated })
    }

    /// How many browsers there are.
    pub fn browsers(&self) -> usize {
        self.watchers.load(Ordering::Relaxed) + self.pilots.load(Ordering::Relaxed)
    }
}

/// The place of one browser, free again when it is dropped.
#[derive(Debug)]
pub struct Seat<'a> {
    rank: Rank,
    seated: &'a AtomicUsize,
}

impl Seat<'_> {
    /// Whom it is for.
    pub fn rank(&self) -> Rank {
        self.rank
    }
}

impl Drop for Seat<'_> {
    fn drop(&mut self) {
        self.seated.fetch_sub(1, Ordering::Relaxed);
    }
}
