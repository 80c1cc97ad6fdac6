//! The connections: how many, how long each may take, and the thread that they are served on.

use std::net::{SocketAddr, TcpListener};
use std::sync::Arc;
use std::thread::{self, JoinHandle};
use std::time::Duration;
use std::{io, pin::pin};

use axum::{Extension, Router, middleware};
use futures_util::future::{Either, select};
use hyper::server::conn::http1;
use hyper_util::rt::{TokioIo, TokioTimer};
use hyper_util::service::TowerToHyperService;
use tokio::net::TcpStream;
use tokio::runtime::{Builder, Runtime};
use tokio::sync::oneshot;
use tokio::time;

use super::connection_slots::{self, NoSlot, Slot, Slots};
use super::login::Peer;
use super::routes;
use super::state::App;
use super::write_timeout::WriteTimeout;

/// How long the head of a request may take.
const HEAD: Duration = Duration::from_secs(10);
/// The longest head, in bytes.
const MOST_HEAD: usize = 16 * 1024;
/// How long to wait when there is no room for another connection, here or in the system.
const FULL: Duration = Duration::from_millis(100);
/// How long work for a page may go on when the pages are closed.
const LAST: Duration = Duration::from_secs(1);
/// Threads for work that waits for the disk.
const AT_THE_DISK: usize = 8;

/// Pages that cannot be served.
#[derive(Debug, thiserror::Error)]
pub enum ServeError {
    /// The address is not free.
    #[error(
        "nothing can be served at {address}; end what is there, or take another port, by `listen` in the settings or `demo --port`"
    )]
    Address {
        /// The address.
        address: SocketAddr,
        /// The system's reason.
        source: io::Error,
    },
    /// No network of this computer has the address.
    #[error(
        "this computer has no address {}; write one of its own as `listen` in the settings, or 0.0.0.0 for all of them",
        address.ip()
    )]
    Elsewhere {
        /// The address.
        address: SocketAddr,
        /// The system's reason.
        source: io::Error,
    },
    /// The system has no thread or no timer for it.
    #[error("the system has no room for the station's pages; end other programs")]
    Room(#[source] io::Error),
}

/// The pages have ended unasked.
#[derive(Debug, thiserror::Error)]
#[error("the pages have ended, by a fault of their own that the log describes; start the program again")]
pub(crate) struct PagesEnded;

/// The pages, which are served until they are closed.
#[derive(Debug)]
pub struct Server {
    app: App,
    stop: oneshot::Sender<()>,
    thread: JoinHandle<()>,
}

impl Server {
    /// Listens on `address`; with port 0 the system chooses one.
    ///
    /// # Errors
    /// [`ServeError::Address`] and [`ServeError::Elsewhere`]
    pub fn listen(address: SocketAddr) -> Result<TcpListener, ServeError> {
        TcpListener::bind(address).map_err(|source| match source.kind() {
            io::ErrorKind::AddrNotAvailable => ServeError::Elsewhere { address, source },
            _ => ServeError::Address { address, source },
        })
    }

    /// Serves the pages of `app`.
    ///
    /// # Errors
    /// [`ServeError::Room`]
    pub fn start(app: &App, listener: TcpListener) -> Result<Self, ServeError> {
        listener.set_nonblocking(true).map_err(ServeError::Room)?;
        let runtime = Builder::new_current_thread().enable_all().max_blocking_threads(AT_THE_DISK).build();
        let (runtime, router) = (runtime.map_err(ServeError::Room)?, routes::router(app));
        let (stop, stopped) = oneshot::channel();
        let slots = Slots::new(app.access().address().may_have_proxy_here());
        let serve = move || serve(runtime, listener, (router, slots), stopped);
        let thread =
            thread::Builder::new().name("pages".to_owned()).spawn(serve).map_err(ServeError::Room)?;
        Ok(Self { app: app.clone(), stop, thread })
    }

    /// Refuses to go on without pages.
    ///
    /// # Errors
    /// [`PagesEnded`] when their thread has ended, or the one that brings them news.
    pub(crate) fn refuse_ended(&self) -> Result<(), PagesEnded> {
        if self.thread.is_finished() || self.app.is_deaf() { Err(PagesEnded) } else { Ok(()) }
    }

    /// Ends all connections.
    pub fn close(self) {
        let _ = self.stop.send(());
        if self.thread.join().is_err() {
            tracing::error!("the pages ended early; look at what was said before");
        }
    }
}

fn serve(
    runtime: Runtime,
    listener: TcpListener,
    (router, slots): (Router, Slots),
    stopped: oneshot::Receiver<()>,
) {
    runtime.block_on(async {
        match tokio::net::TcpListener::from_std(listener) {
            Ok(listener) => drop(select(pin!(accept(listener, router, slots)), stopped).await),
            Err(error) => tracing::error!("the pages cannot be served: {error}"),
        }
    });
    runtime.shutdown_timeout(LAST);
}

async fn accept(listener: tokio::net::TcpListener, router: Router, slots: Slots) {
    loop {
        match listener.accept().await {
            Ok((stream, peer)) => {
                let Some(slot) = slot(&slots, peer).await else { continue };
                let slot = Arc::new(slot);
                let noted = middleware::from_fn_with_state(Arc::clone(&slot), connection_slots::noted);
                let router = router.clone().layer(noted).layer(Extension(Peer(peer.ip())));
                drop(tokio::spawn(connection(stream, router, slot)));
            }
            Err(error) => {
                tracing::warn!("a connection was not taken: {error}");
                time::sleep(FULL).await;
            }
        }
    }
}

/// A slot for `peer`; none if it has too many. If all are taken, it waits until one is free.
async fn slot(slots: &Slots, peer: SocketAddr) -> Option<Slot> {
    loop {
        match slots.take(peer.ip()) {
            Ok(slot) => return Some(slot),
            Err(NoSlot::OfOne) => return None,
            Err(NoSlot::OfAll) => time::sleep(FULL).await,
        }
    }
}

async fn connection(stream: TcpStream, router: Router, slot: Arc<Slot>) {
    // News are short, and pages wait for each.
    let _ = stream.set_nodelay(true);
    let mut builder = http1::Builder::new();
    builder.timer(TokioTimer::new()).header_read_timeout(HEAD).max_header_size(MOST_HEAD);
    let served =
        builder.serve_connection(TokioIo::new(WriteTimeout::new(stream)), TowerToHyperService::new(router));
    // First whether it is to give way: else an act that has just arrived would be begun, and its answer cut off.
    match select(pin!(slot.is_lost()), pin!(served)).await {
        Either::Left(_) => tracing::debug!("a connection gave way to another one"),
        Either::Right((Err(error), _)) => tracing::debug!("a connection ended: {error}"),
        Either::Right((Ok(()), _)) => {}
    }
}

#[cfg(test)]
mod tests {
    use std::fs::File;
    use std::io::Write as _;
    use std::os::fd::OwnedFd;
    use std::sync::atomic::{AtomicBool, Ordering};
    use std::time::Instant;

    use axum::routing::get;

    use super::*;
    use crate::web::request_guard::tests::station;

    #[test]
    fn a_connection_that_is_to_give_way_begins_nothing_more() {
        let runtime = Builder::new_current_thread().enable_all().build().unwrap();
        let begun = |gives_way: bool| async move {
            let listener = tokio::net::TcpListener::bind("127.0.0.1:0").await.unwrap();
            let mut client = std::net::TcpStream::connect(listener.local_addr().unwrap()).unwrap();
            let (stream, peer) = listener.accept().await.unwrap();
            client.write_all(b"GET / HTTP/1.1\r\nhost: here\r\nconnection: close\r\n\r\n").unwrap();
            stream.readable().await.unwrap();
            let (slots, asked) = (Slots::new(false), Arc::new(AtomicBool::new(false)));
            let slot = Arc::new(slots.take(peer.ip()).unwrap());
            // docs/station-lanes.md: one address holds at most 48.
            let _others: Vec<_> =
                (0..if gives_way { 48 } else { 47 }).map(|_| slots.take(peer.ip())).collect();
            let noted = Arc::clone(&asked);
            let answer = move || {
                noted.store(true, Ordering::Relaxed);
                std::future::ready("")
            };
            connection(stream, Router::new().route("/", get(answer)), slot).await;
            asked.load(Ordering::Relaxed)
        };
        assert!(runtime.block_on(begun(false)), "the control");
        assert!(!runtime.block_on(begun(true)));
    }

    #[test]
    fn pages_that_cannot_be_served_are_not_waited_for() {
        let folder = tempfile::tempdir().unwrap();
        let (app, engine) = station(folder.path());
        let well = Server::start(&app, Server::listen("127.0.0.1:0".parse().unwrap()).unwrap()).unwrap();
        // The system tells of no connections to a file, as epoll_ctl(2) says.
        let none = OwnedFd::from(File::open(folder.path().join("station.toml")).unwrap());
        let server = Server::start(&app, none.into()).unwrap();
        let begun = Instant::now();
        while server.refuse_ended().is_ok() {
            assert!(begun.elapsed() < Duration::from_secs(60), "they are waited for");
            thread::sleep(FULL);
        }
        assert!(well.refuse_ended().is_ok(), "the control");
        well.close();
        engine.close(None);
    }

    /// Every page would say NOT LIVE until somebody starts the station again.
    #[test]
    fn pages_that_hear_no_news_are_not_served_any_longer() {
        let folder = tempfile::tempdir().unwrap();
        let (app, engine) = station(folder.path());
        let server = Server::start(&app, Server::listen("127.0.0.1:0".parse().unwrap()).unwrap()).unwrap();
        assert!(server.refuse_ended().is_ok(), "the control");
        // Its listener ends with it, as by a fault.
        engine.close(None);
        let begun = Instant::now();
        while server.refuse_ended().is_ok() {
            assert!(begun.elapsed() < Duration::from_secs(60), "nobody notices");
            thread::sleep(FULL);
        }
        server.close();
    }

    /// 192.0.2.0/24 is for documentation alone, so no computer has it (RFC 5737).
    #[test]
    fn an_address_of_another_computer_is_not_said_to_be_in_use() {
        let error = Server::listen("192.0.2.1:8612".parse().unwrap()).unwrap_err().to_string();
        assert!(error.starts_with("this computer has no address 192.0.2.1; "), "{error}");
        let taken = TcpListener::bind("127.0.0.1:0").unwrap();
        let error = Server::listen(taken.local_addr().unwrap()).unwrap_err().to_string();
        assert!(error.contains("; end what is there, or take another port"), "{error}");
    }
}
