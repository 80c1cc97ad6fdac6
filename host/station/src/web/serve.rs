//! The connections: how many, how long each may take, and the thread that they are served on.

use std::collections::HashMap;
use std::net::{IpAddr, SocketAddr, TcpListener};
use std::sync::Arc;
use std::thread::{self, JoinHandle};
use std::time::Duration;
use std::{io, pin::pin};

use axum::{Extension, Router};
use hyper::server::conn::http1;
use hyper_util::rt::{TokioIo, TokioTimer};
use hyper_util::service::TowerToHyperService;
use tokio::net::TcpStream;
use tokio::runtime::{Builder, Runtime};
use tokio::sync::{OwnedSemaphorePermit, Semaphore, oneshot};
use tokio::time;

use super::access::network;
use super::login::Peer;
use super::patient::Patient;
use super::routes;
use super::state::App;

/// How many connections there are at once; another one waits for its turn.
const CONNECTIONS: usize = 64;
/// How many of them one other computer has, so that nobody keeps all others from the pages; another one is closed.
const CONNECTIONS_OF_ONE: usize = 48;
/// How long the head of a request may take.
const HEAD: Duration = Duration::from_secs(10);
/// The longest head, in bytes.
const MOST_HEAD: usize = 16 * 1024;
/// How long it is waited when the system has no room for another connection.
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
        "nothing can be served at {address}; end what is there, or take another port, by `listen` in the settings or by --port"
    )]
    Address {
        /// The address.
        address: SocketAddr,
        /// The system's reason.
        source: io::Error,
    },
    /// The system has no thread or no timer for it.
    #[error("the system has no room for the station's pages; end other programs")]
    Room(#[source] io::Error),
}

/// The pages, which are served until they are closed.
#[derive(Debug)]
pub struct Server {
    stop: oneshot::Sender<()>,
    thread: JoinHandle<()>,
}

impl Server {
    /// Listens on `address`; with port 0 the system chooses one.
    ///
    /// # Errors
    /// [`ServeError::Address`]
    pub fn listen(address: SocketAddr) -> Result<TcpListener, ServeError> {
        TcpListener::bind(address).map_err(|source| ServeError::Address { address, source })
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
        let serve = move || serve(runtime, listener, router, stopped);
        let thread =
            thread::Builder::new().name("pages".to_owned()).spawn(serve).map_err(ServeError::Room)?;
        Ok(Self { stop, thread })
    }

    /// Ends all connections.
    pub fn close(self) {
        let _ = self.stop.send(());
        if self.thread.join().is_err() {
            tracing::error!("the pages ended early; look at what was said before");
        }
    }
}

fn serve(runtime: Runtime, listener: TcpListener, router: Router, stopped: oneshot::Receiver<()>) {
    runtime.block_on(async {
        match tokio::net::TcpListener::from_std(listener) {
            Ok(listener) => drop(tokio::spawn(accept(listener, router))),
            Err(error) => tracing::error!("the pages cannot be served: {error}"),
        }
        let _ = stopped.await;
    });
    runtime.shutdown_timeout(LAST);
}

async fn accept(listener: tokio::net::TcpListener, router: Router) {
    let places = Arc::new(Semaphore::new(CONNECTIONS));
    let mut peers = Peers::default();
    while let Ok(place) = Arc::clone(&places).acquire_owned().await {
        match listener.accept().await {
            Ok((stream, peer)) => {
                let Some(own) = peers.place(peer.ip()) else { continue };
                let router = router.clone().layer(Extension(Peer(peer.ip())));
                drop(tokio::spawn(connection(stream, router, (place, own))));
            }
            Err(error) => {
                tracing::warn!("a connection was not taken: {error}");
                time::sleep(FULL).await;
            }
        }
    }
}

/// The connections of each address.
#[derive(Debug, Default)]
struct Peers(HashMap<IpAddr, Arc<()>>);

impl Peers {
    /// A place for one more of `peer`, which is free again when it is dropped; none if it has too many. This computer, where a proxy
    /// may be, has as many as there are.
    fn place(&mut self, peer: IpAddr) -> Option<Arc<()>> {
        self.0.retain(|_, its| Arc::strong_count(its) > 1);
        let its = self.0.entry(network(peer)).or_default();
        let is_free = peer.to_canonical().is_loopback() || Arc::strong_count(its) <= CONNECTIONS_OF_ONE;
        is_free.then(|| Arc::clone(its))
    }
}

async fn connection(stream: TcpStream, router: Router, places: (OwnedSemaphorePermit, Arc<()>)) {
    // News are short, and each is waited for.
    let _ = stream.set_nodelay(true);
    let mut builder = http1::Builder::new();
    builder.timer(TokioTimer::new()).header_read_timeout(HEAD).max_header_size(MOST_HEAD);
    let served =
        builder.serve_connection(TokioIo::new(Patient::new(stream)), TowerToHyperService::new(router));
    if let Err(error) = pin!(served).await {
        tracing::debug!("a connection ended: {error}");
    }
    drop(places);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nobody_has_all_connections_but_this_computer() {
        let mut peers = Peers::default();
        let [one, other, here] = ["10.0.0.1", "10.0.0.2", "127.0.0.1"].map(|peer| peer.parse().unwrap());
        let mut places: Vec<_> = (0..CONNECTIONS_OF_ONE).map(|_| peers.place(one).unwrap()).collect();
        assert!(peers.place(one).is_none() && peers.place(other).is_some());
        places.pop();
        assert!(peers.place(one).is_some());
        let all: Option<Vec<_>> = (0..CONNECTIONS).map(|_| peers.place(here)).collect();
        assert!(all.is_some());
    }
}
