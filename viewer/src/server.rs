//! The server: a thread of its own, so that browsers cost the simulation nothing.

use std::net::{IpAddr, Ipv4Addr, Ipv6Addr, SocketAddr, TcpListener};
use std::sync::Arc;
use std::sync::mpsc::{Receiver, sync_channel};
use std::thread::JoinHandle;
use std::time::Duration;

use axum::Router;
use axum::body::{Body, Bytes, to_bytes};
use axum::extract::connect_info::IntoMakeServiceWithConnectInfo;
use axum::extract::ws::{Utf8Bytes, WebSocketUpgrade};
use axum::extract::{ConnectInfo, Request, State};
use axum::http::{HeaderMap, HeaderValue, StatusCode, Uri, header};
use axum::middleware::{Next, from_fn_with_state};
use axum::response::{IntoResponse, Response};
use axum::routing::{any, get, post};
use serde::Serialize;
use tokio::sync::{oneshot, watch};

use crate::assets::asset;
use crate::bounded_listener::{BoundedListener, Work};
use crate::client;
use crate::frame::Frame;
use crate::guard;
use crate::hub::Hub;
use crate::news::News;
use crate::order::Order;
use crate::recording::Recording;
use crate::replayer::{NoFilm, Replayer};
use crate::scene::Scene;
use crate::token::Token;

/// Orders that wait for the simulation.
const MOST_ORDERS: usize = 64;
/// Longest message of a browser, bytes.
const LONGEST_MESSAGE: usize = 4096;
/// Bytes of the largest record that a browser may send: hours of flight.
const LARGEST_RECORD: usize = 256 << 20;
/// A connection on which nothing comes and goes for this long is closed: browsers keep some that they may never use.
const IDLE: Duration = Duration::from_secs(10);

/// What every answer says: nothing from other hosts, nothing inline, in no other page, and the address goes nowhere.
const PROTECTION: [(header::HeaderName, HeaderValue); 5] = [
    (
        header::CONTENT_SECURITY_POLICY,
        HeaderValue::from_static(
            "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self'; connect-src 'self'; \
             base-uri 'none'; form-action 'none'; frame-ancestors 'none'",
        ),
    ),
    (header::X_CONTENT_TYPE_OPTIONS, HeaderValue::from_static("nosniff")),
    (header::REFERRER_POLICY, HeaderValue::from_static("no-referrer")),
    (header::X_FRAME_OPTIONS, HeaderValue::from_static("DENY")),
    // Another version of the program may serve the next page.
    (header::CACHE_CONTROL, HeaderValue::from_static("no-cache")),
];

/// Why there is no page.
#[derive(Debug, thiserror::Error)]
pub enum ViewerError {
    /// The address cannot be used.
    #[error("cannot listen on {address}: {source}; choose another address or port")]
    Address {
        /// The address.
        address: String,
        /// Why.
        source: std::io::Error,
    },
    /// The thread of the server cannot start.
    #[error("cannot start the server: {0}")]
    Start(std::io::Error),
    /// There is no secret token.
    #[error("cannot make a token: {0}")]
    Token(#[from] getrandom::Error),
}

/// Flights of the past that the page can show.
#[derive(Clone, Debug, Default)]
pub struct Past {
    /// What the page opens instead of a live flight.
    pub recording: Option<Recording>,
    /// Who flies records again that are opened in the page.
    pub replayer: Option<Replayer>,
}

/// A running server.
#[derive(Debug)]
pub struct Viewer {
    hub: Arc<Hub>,
    address: SocketAddr,
    orders: Receiver<Order>,
    stop: Option<oneshot::Sender<()>>,
    thread: Option<JoinHandle<()>>,
}

impl Viewer {
    /// Listens on a host and a port; port 0 is any free one.
    ///
    /// # Errors
    /// [`ViewerError`]
    pub fn open(host: &str, port: u16, past: Past) -> Result<Self, ViewerError> {
        let unusable = |source| ViewerError::Address { address: format!("{host}:{port}"), source };
        let bare = host.trim_start_matches('[').trim_end_matches(']');
        let listener = TcpListener::bind((bare, port)).map_err(unusable)?;
        listener.set_nonblocking(true).map_err(unusable)?;
        let address = listener.local_addr().map_err(unusable)?;
        let (sender, orders) = sync_channel(MOST_ORDERS);
        let hub = Arc::new(Hub::new(bare.to_owned(), Token::random()?, sender, past));
        let (stop, stopped) = oneshot::channel();
        let runtime = tokio::runtime::Builder::new_current_thread()
            .enable_io()
            .enable_time()
            .build()
            .map_err(ViewerError::Start)?;
        let served = Arc::clone(&hub);
        let run = move || {
            runtime.block_on(async {
                let Ok(listener) = tokio::net::TcpListener::from_std(listener) else { return };
                tokio::select! {
                    _stopped = stopped => {}
                    _never = axum::serve(BoundedListener::new(listener, IDLE), service(served)) => {}
                }
            });
            // Nobody waits for a record that is being replayed.
            runtime.shutdown_background();
        };
        let thread =
            std::thread::Builder::new().name("viewer".to_owned()).spawn(run).map_err(ViewerError::Start)?;
        Ok(Self { hub, address, orders, stop: Some(stop), thread: Some(thread) })
    }

    /// Where it listens.
    pub fn address(&self) -> SocketAddr {
        self.address
    }

    /// The address of the page for someone who may give orders.
    pub fn pilot_url(&self) -> String {
        // What listens everywhere is reached here by loopback.
        let ip = match self.address.ip() {
            IpAddr::V4(ip) if ip.is_unspecified() => IpAddr::V4(Ipv4Addr::LOCALHOST),
            IpAddr::V6(ip) if ip.is_unspecified() => IpAddr::V6(Ipv6Addr::LOCALHOST),
            ip => ip,
        };
        let address = SocketAddr::new(ip, self.address.port());
        // Behind a # the token goes into no request, no log and no other page.
        format!("http://{address}/#token={}", self.hub.token.secret())
    }

    /// Whether anybody looks on.
    pub fn is_watched(&self) -> bool {
        self.hub.browsers() > 0
    }

    /// Replaces the frame that browsers get next, if it has changed. Never waits.
    pub fn show(&self, frame: &Frame) {
        let bytes = frame.encode();
        self.hub.frames.send_if_modified(|present| {
            let differs = *present != bytes;
            if differs {
                *present = Bytes::from(bytes);
            }
            differs
        });
    }

    /// Replaces the scene, if it has changed.
    pub fn show_scene(&self, scene: &Scene) {
        publish(&self.hub.scene, "scene", scene);
    }

    /// Replaces the news, if they have changed.
    pub fn tell(&self, news: &News) {
        publish(&self.hub.news, "news", news);
    }

    /// The next order that a pilot has given.
    pub fn next_order(&self) -> Option<Order> {
        self.orders.try_recv().ok()
    }
}

impl Drop for Viewer {
    fn drop(&mut self) {
        if let Some(stop) = self.stop.take() {
            let _ended = stop.send(());
        }
        if let Some(thread) = self.thread.take() {
            let _panicked = thread.join();
        }
    }
}

fn publish(slot: &watch::Sender<Utf8Bytes>, name: &str, content: &impl Serialize) {
    let text = serde_json::json!({ name: content }).to_string();
    slot.send_if_modified(|present| {
        let differs = present.as_str() != text;
        if differs {
            *present = Utf8Bytes::from(text);
        }
        differs
    });
}

fn service(hub: Arc<Hub>) -> IntoMakeServiceWithConnectInfo<Router, Work> {
    Router::new()
        .route("/stream", any(stream))
        .route("/session.json", get(session))
        .route("/recording", get(recording))
        .route("/film", post(film))
        .fallback(get(file))
        .layer(from_fn_with_state(Arc::clone(&hub), protect))
        .with_state(hub)
        .into_make_service_with_connect_info()
}

/// Refuses strangers, and sets what every answer says.
async fn protect(State(hub): State<Arc<Hub>>, request: Request, next: Next) -> Response {
    let mut response = match guard::check(request.headers(), &hub.host) {
        Ok(()) => next.run(request).await,
        Err(stranger) => (StatusCode::FORBIDDEN, stranger.reason()).into_response(),
    };
    response.headers_mut().extend(PROTECTION.map(|(name, value)| (name, value)));
    response
}

async fn stream(
    State(hub): State<Arc<Hub>>,
    ConnectInfo(work): ConnectInfo<Work>,
    upgrade: WebSocketUpgrade,
) -> Response {
    upgrade.max_message_size(LONGEST_MESSAGE).max_frame_size(LONGEST_MESSAGE).on_upgrade(
        async move |socket| {
            // Nothing is sent while nothing changes.
            let _lasting = work.begin();
            client::serve(socket, hub).await;
        },
    )
}

/// What the page is for.
async fn session(State(hub): State<Arc<Hub>>) -> Response {
    let recording = hub.past.recording.as_ref().map(Recording::name);
    let session = serde_json::json!({ "recording": recording }).to_string();
    ([(header::CONTENT_TYPE, "application/json")], session).into_response()
}

async fn recording(State(hub): State<Arc<Hub>>) -> Response {
    match &hub.past.recording {
        Some(recording) => {
            ([(header::CONTENT_TYPE, "application/octet-stream")], recording.content()).into_response()
        }
        None => {
            (StatusCode::NOT_FOUND, "There is no recording: start with --view-record FILE.\n").into_response()
        }
    }
}

/// A record that was flown again.
async fn film(
    State(hub): State<Arc<Hub>>,
    ConnectInfo(work): ConnectInfo<Work>,
    headers: HeaderMap,
    body: Body,
) -> Response {
    let refused = |status, why: &str| (status, why.to_owned()).into_response();
    let Some(replayer) = &hub.past.replayer else {
        return refused(StatusCode::NOT_FOUND, "this program replays no records");
    };
    if !is_trusted(&headers, &hub.token) {
        let why =
            "only a page with the token can have records replayed: open the address that lmpc-sitl printed";
        return refused(StatusCode::FORBIDDEN, why);
    }
    let largest = LARGEST_RECORD >> 20;
    let too_large =
        || NoFilm::Refused(format!("larger than {largest} MiB; run lmpc-sitl --view-record with it"));
    let mut _lasting = None;
    let record = async {
        let record = to_bytes(body, LARGEST_RECORD).await.map_err(|_| too_large());
        // Until here a silent client is cut off, and lets others have theirs replayed.
        _lasting = Some(work.begin());
        record
    };
    match replayer.film(record).await {
        Ok(film) => ([(header::CONTENT_TYPE, "application/octet-stream")], film).into_response(),
        Err(NoFilm::Busy) => refused(StatusCode::CONFLICT, "another record is being replayed; try again"),
        Err(NoFilm::Refused(why)) => refused(StatusCode::UNPROCESSABLE_ENTITY, &why),
    }
}

/// Whether a request has the token, as a bearer.
fn is_trusted(headers: &HeaderMap, token: &Token) -> bool {
    let value = headers.get(header::AUTHORIZATION).and_then(|value| value.to_str().ok());
    value.and_then(|value| value.strip_prefix("Bearer ")).is_some_and(|word| token.is(word))
}

async fn file(headers: HeaderMap, uri: Uri) -> Response {
    let Some(asset) = asset(uri.path()) else {
        return (StatusCode::NOT_FOUND, "There is no such file.\n").into_response();
    };
    let head = [(header::CONTENT_TYPE, asset.content_type), (header::VARY, "accept-encoding")];
    if takes_gzip(&headers) {
        (head, [(header::CONTENT_ENCODING, "gzip")], asset.packed).into_response()
    } else {
        (head, asset.content()).into_response()
    }
}

/// Whether a client unpacks gzip (RFC 9110, section 12.5.3).
fn takes_gzip(headers: &HeaderMap) -> bool {
    let values = headers.get_all(header::ACCEPT_ENCODING).iter().filter_map(|value| value.to_str().ok());
    values.flat_map(|value| value.split(',')).any(|coding| {
        let (name, weight) = coding.split_once(';').unwrap_or((coding, ""));
        // A weight of zero refuses.
        let refused = weight.trim().strip_prefix("q=").is_some_and(|q| q.trim().parse() == Ok(0.0));
        name.trim().eq_ignore_ascii_case("gzip") && !refused
    })
}
