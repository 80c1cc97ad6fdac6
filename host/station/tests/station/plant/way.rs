//! A relay to the server that cuts connections at COMMITs.

use std::io::{Read as _, Write as _};
use std::net::{Shutdown, TcpListener, TcpStream};
use std::sync::Arc;
use std::thread;
use std::time::Duration;

/// Where a connection is cut.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Cut {
    /// The server never sees the COMMIT.
    Before,
    /// The server carries it out, and nobody learns of it.
    After,
    /// The server never sees it, but the station is told that it was carried out.
    Pretended,
}

/// A server's answer to a COMMIT: CommandComplete, and ReadyForQuery outside a transaction (PostgreSQL, 55.7).
const COMMITTED: &[u8] = b"C\0\0\0\x0bCOMMIT\0Z\0\0\0\x05I";

/// A relay to the server on the port `to`, which cuts those COMMITs for which `cuts` returns a way. `cuts` gets the number of
/// bytes that went to the server since the previous COMMIT. Returns the relay's port.
pub(crate) fn way(to: u16, cuts: impl Fn(usize) -> Option<Cut> + Send + Sync + 'static) -> u16 {
    let listener = TcpListener::bind("127.0.0.1:0").unwrap();
    let port = listener.local_addr().unwrap().port();
    let cuts = Arc::new(cuts);
    thread::spawn(move || {
        for client in listener.incoming() {
            let (client, cuts) = (client.unwrap(), Arc::clone(&cuts));
            // A client is disconnected when the server is not there.
            let Ok(server) = TcpStream::connect(("127.0.0.1", to)) else { continue };
            let (from, back) = (server.try_clone().unwrap(), client.try_clone().unwrap());
            thread::spawn(move || carried(from, &back, |_| true));
            thread::spawn(move || {
                let asked = client.try_clone().unwrap();
                let mut since = 0;
                carried(asked, &server, |bytes| {
                    since += bytes.len();
                    let is_commit = bytes.windows(6).any(|word| word == b"COMMIT");
                    let cut = if is_commit { cuts(std::mem::take(&mut since)) } else { None };
                    cut.is_none_or(|cut| carry_out(cut, bytes, &client, &server))
                });
                let _ = client.shutdown(Shutdown::Both);
            });
        }
    });
    port
}

/// Cuts a connection at this COMMIT. Returns whether the connection goes on, which is never.
fn carry_out(cut: Cut, commit: &[u8], mut client: &TcpStream, mut server: &TcpStream) -> bool {
    match cut {
        Cut::Before => {}
        Cut::After => {
            let _ = client.shutdown(Shutdown::Both);
            if server.write_all(commit).is_ok() {
                // It has carried it out by the time it waits for more.
                thread::sleep(Duration::from_millis(50));
            }
        }
        Cut::Pretended => drop(client.write_all(COMMITTED)),
    }
    let _ = server.shutdown(Shutdown::Both);
    false
}

fn some(from: &mut TcpStream) -> Option<Vec<u8>> {
    let mut bytes = vec![0; 65_536];
    let read = from.read(&mut bytes).ok().filter(|read| *read > 0)?;
    bytes.truncate(read);
    Some(bytes)
}

/// Forwards bytes for as long as `watch` allows.
fn carried(mut from: TcpStream, mut to: &TcpStream, mut watch: impl FnMut(&[u8]) -> bool) {
    while let Some(bytes) = some(&mut from) {
        if !watch(&bytes) || to.write_all(&bytes).is_err() {
            break;
        }
    }
    let _ = to.shutdown(Shutdown::Both);
}
