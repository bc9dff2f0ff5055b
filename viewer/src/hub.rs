//! What the simulation's thread and the browsers' tasks share.

use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::mpsc::SyncSender;

use axum::body::Bytes;
use axum::extract::ws::Utf8Bytes;
use tokio::sync::watch;

use crate::order::Order;
use crate::recording::Recording;
use crate::token::Token;

/// Browsers at once.
const MOST_BROWSERS: usize = 32;

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
    /// What the page opens instead of a flight.
    pub recording: Option<Recording>,
    browsers: AtomicUsize,
}

impl Hub {
    /// Nothing is published yet.
    pub fn new(host: String, token: Token, orders: SyncSender<Order>, recording: Option<Recording>) -> Self {
        Self {
            host,
            token,
            frames: watch::Sender::new(Bytes::new()),
            scene: watch::Sender::new(Utf8Bytes::default()),
            news: watch::Sender::new(Utf8Bytes::default()),
            orders,
            recording,
            browsers: AtomicUsize::new(0),
        }
    }

    /// Lets a browser in, while there are not too many.
    pub fn seat(&self) -> Option<Seat<'_>> {
        let taken = |count| (count < MOST_BROWSERS).then_some(count + 1);
        let free = self.browsers.fetch_update(Ordering::Relaxed, Ordering::Relaxed, taken);
        free.is_ok().then_some(Seat(self))
    }

    /// How many browsers look on.
    pub fn browsers(&self) -> usize {
        self.browsers.load(Ordering::Relaxed)
    }
}

/// The place of one browser, free again when it is dropped.
#[derive(Debug)]
pub struct Seat<'a>(&'a Hub);

impl Drop for Seat<'_> {
    fn drop(&mut self) {
        self.0.browsers.fetch_sub(1, Ordering::Relaxed);
    }
}
