//! One browser, from its connection to its end.

use std::sync::Arc;
use std::sync::mpsc::TrySendError;
use std::time::Duration;

use axum::extract::ws::{CloseFrame, Message, WebSocket, close_code};
use serde::Deserialize;
use tokio::sync::mpsc;

use crate::hub::{Hub, Rank, Seat};
use crate::order::{Order, Reply, SentOrder};

/// A browser that takes nothing for this long is gone.
const PATIENCE: Duration = Duration::from_secs(10);
/// Where all places for watchers are taken, who does not say at once that it may give orders is sent away.
const INTRODUCTION: Duration = Duration::from_secs(3);
/// Answers that wait for a browser.
const MOST_ANSWERS: usize = 64;

/// What a browser says first, if it wants to give orders.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Introduction {
    token: String,
}

/// What is left of an order that cannot be read: the number that its answer needs.
#[derive(Deserialize)]
struct Numbered {
    order: u64,
}

/// Serves a browser until it leaves. What it is too slow for is replaced by what is newer.
pub async fn serve(mut socket: WebSocket, hub: Arc<Hub>) {
    let (answers, mut answered) = mpsc::channel(MOST_ANSWERS);
    let mut pilot = Pilot { hub: &hub, answers, is_trusted: false };
    let seat = match hub.seat(Rank::Watcher) {
        Some(seat) => Some(seat),
        None => pilots_seat(&mut socket, &mut pilot).await,
    };
    let Some(mut seat) = seat else { return send_away(socket).await };
    let (mut frames, mut scene, mut news) =
        (hub.frames.subscribe(), hub.scene.subscribe(), hub.news.subscribe());
    scene.mark_changed();
    news.mark_changed();
    frames.mark_changed();
    loop {
        // The rare before the frequent: frames must not starve it.
        let message = tokio::select! {
            biased;
            received = socket.recv() => match received {
                Some(Ok(Message::Text(text))) => {
                    let answer = pilot.hear(text.as_str());
                    seat = pilot.better(seat);
                    answer.map(|answer| Message::Text(answer.into()))
                }
                Some(Ok(Message::Close(_)) | Err(_)) | None => return,
                Some(Ok(_)) => None,
            },
            Some(answer) = answered.recv() => Some(Message::Text(answer.into())),
            Ok(()) = scene.changed() => Some(Message::Text(scene.borrow_and_update().clone())),
            Ok(()) = news.changed() => Some(Message::Text(news.borrow_and_update().clone())),
            Ok(()) = frames.changed() => Some(Message::Binary(frames.borrow_and_update().clone())),
        };
        let Some(message) = message.filter(|message| !is_empty(message)) else { continue };
        match tokio::time::timeout(PATIENCE, socket.send(message)).await {
            Ok(Ok(())) => {}
            Ok(Err(_)) | Err(_) => return,
        }
    }
}

/// A place among the pilots for who shows the token.
async fn pilots_seat<'a>(socket: &mut WebSocket, pilot: &mut Pilot<'a>) -> Option<Seat<'a>> {
    let Ok(Some(Ok(Message::Text(text)))) = tokio::time::timeout(INTRODUCTION, socket.recv()).await else {
        return None;
    };
    let answer = pilot.hear(text.as_str())?;
    let seat = pilot.is_trusted.then(|| pilot.hub.seat(Rank::Pilot)).flatten()?;
    let sent = tokio::time::timeout(PATIENCE, socket.send(Message::Text(answer.into()))).await;
    matches!(sent, Ok(Ok(()))).then_some(seat)
}

/// Tells a browser that there is no place.
async fn send_away(mut socket: WebSocket) {
    let reason = CloseFrame { code: close_code::AGAIN, reason: "too many browsers".into() };
    let _gone = tokio::time::timeout(PATIENCE, socket.send(Message::Close(Some(reason)))).await;
}

/// Before anything is published there is nothing to send.
fn is_empty(message: &Message) -> bool {
    match message {
        Message::Text(text) => text.as_str().is_empty(),
        Message::Binary(bytes) => bytes.is_empty(),
        _ => false,
    }
}

/// Whoever sits before the browser.
struct Pilot<'a> {
    hub: &'a Hub,
    answers: mpsc::Sender<String>,
    is_trusted: bool,
}

impl<'a> Pilot<'a> {
    /// Leaves the place of a watcher to others, if it has one among the pilots.
    fn better(&self, seat: Seat<'a>) -> Seat<'a> {
        let moves = self.is_trusted && seat.rank() == Rank::Watcher;
        moves.then(|| self.hub.seat(Rank::Pilot)).flatten().unwrap_or(seat)
    }

    /// Takes in what a browser says. Returns what to answer at once.
    fn hear(&mut self, text: &str) -> Option<String> {
        if let Ok(Introduction { token }) = serde_json::from_str(text) {
            self.is_trusted = self.hub.token.is(&token);
            return Some(serde_json::json!({ "controls": self.is_trusted }).to_string());
        }
        let refused = |number: Option<u64>, reason: String| {
            Some(serde_json::json!({ "answer": number, "refused": reason }).to_string())
        };
        let SentOrder { order, vehicle, please } = match serde_json::from_str(text) {
            Ok(sent) => sent,
            Err(error) => {
                let number = serde_json::from_str(text).ok().map(|Numbered { order }| order);
                return refused(number, format!("not an order: {error}"));
            }
        };
        if !self.is_trusted {
            let reason = "view only: open the address with the token that lmpc-sitl printed";
            return refused(Some(order), reason.to_owned());
        }
        let reply = Reply::new(order, self.answers.clone());
        match self.hub.orders.try_send(Order { vehicle, action: please, reply }) {
            Ok(()) => None,
            Err(TrySendError::Full(_)) => {
                refused(Some(order), "too many orders at once; try again".to_owned())
            }
            Err(TrySendError::Disconnected(_)) => refused(Some(order), "the flight is over".to_owned()),
        }
    }
}
