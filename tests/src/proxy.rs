//! A TCP proxy that does to a connection what poor links do: it stalls, loses, repeats or delays.

use std::io::{self, Read as _, Write as _};
use std::net::{Shutdown, TcpListener, TcpStream};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

use halfrow_protocol::message::RowOut;
use halfrow_protocol::{Decoder, Encoder, Reply};

use crate::altered::Passing;
use crate::dice::Dice;
use crate::parallel::end_beside;

/// How often each thread checks whether to end.
const TICK: Duration = Duration::from_millis(20);

/// What happens to one direction of the connection.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Suffers {
    /// Nothing.
    #[default]
    Nothing,
    /// It stalls after every `every` bytes.
    Stalls {
        /// Bytes between two stalls.
        every: usize,
        /// How long one lasts.
        time: Duration,
        /// Whether the other direction stalls with it.
        both: bool,
    },
    /// Packets of at least `least` bytes get lost at a rate.
    Loses {
        /// Bytes between a packet's zeros.
        least: usize,
        /// The share of those packets that get lost, 0 to 1.
        rate: f64,
    },
    /// A copy of a packet follows some packets later, at a rate.
    Repeats {
        /// How many packets later.
        later: usize,
        /// The share of packets that are copied, 0 to 1.
        rate: f64,
    },
    /// A bit of the last sample of every row is changed, and the CRC with it. No link does that: it is what a judge cannot see
    /// through.
    Forges,
}

/// A proxy that serves one connection at a time until it is dropped.
#[derive(Debug)]
pub struct Proxy {
    target: String,
    ended: Arc<AtomicBool>,
    thread: Option<JoinHandle<()>>,
}

impl Proxy {
    /// A proxy in front of `address`, HOST:PORT, and what happens to bytes to the board and to the host; `seed` draws what is
    /// hit.
    ///
    /// # Panics
    /// If there is no free port.
    #[must_use]
    pub fn before(address: &str, to_board: Suffers, to_host: Suffers, seed: u64) -> Self {
        let listener = TcpListener::bind("127.0.0.1:0").unwrap();
        listener.set_nonblocking(true).unwrap();
        let target = format!("tcp:{}", listener.local_addr().unwrap());
        let (ended, address) = (Arc::new(AtomicBool::new(false)), address.to_owned());
        let thread = std::thread::spawn({
            let ended = Arc::clone(&ended);
            move || {
                while !ended.load(Ordering::Relaxed) {
                    match listener.accept() {
                        // The host is to notice that its connection broke.
                        Ok((host, _)) => _ = carry(&host, &address, [to_board, to_host], seed, &ended),
                        Err(_) => std::thread::sleep(TICK / 4),
                    }
                }
            }
        });
        Self { target, ended, thread: Some(thread) }
    }

    /// The target that leads through the proxy.
    #[must_use]
    pub fn target(&self) -> &str {
        &self.target
    }
}

impl Drop for Proxy {
    fn drop(&mut self) {
        self.ended.store(true, Ordering::Relaxed);
        end_beside(self.thread.take());
    }
}

fn carry(
    host: &TcpStream,
    address: &str,
    suffers: [Suffers; 2],
    seed: u64,
    ended: &AtomicBool,
) -> io::Result<()> {
    let board = TcpStream::connect(address)?;
    for end in [host, &board] {
        end.set_nonblocking(false)?;
        end.set_nodelay(true)?;
        end.set_read_timeout(Some(TICK))?;
        end.set_write_timeout(Some(TICK))?;
    }
    let still = [Mutex::new(Instant::now()), Mutex::new(Instant::now())];
    std::thread::scope(|scope| {
        for (way, (from, to)) in [(host, &board), (&board, host)].into_iter().enumerate() {
            let (still, suffers) = (&still, suffers[way]);
            scope.spawn(move || {
                let mut direction = Direction::new(suffers, seed.wrapping_mul(2).wrapping_add(way as u64));
                let _ = direction.run(from, to, way, still, ended);
                // Tells both ends that it is over.
                let _ = (from.shutdown(Shutdown::Both), to.shutdown(Shutdown::Both));
            });
        }
    });
    Ok(())
}

/// One direction of a connection.
struct Direction {
    suffers: Suffers,
    dice: Dice,
    /// Bytes since the last stall.
    since: usize,
    /// The packet that is arriving.
    packet: Vec<u8>,
    /// Copies that wait, with the number of packets until each is sent.
    copies: Vec<(usize, Vec<u8>)>,
    decoder: Decoder,
    encoder: Encoder,
}

impl Direction {
    fn new(suffers: Suffers, seed: u64) -> Self {
        Self {
            suffers,
            dice: Dice::new(seed),
            since: 0,
            packet: Vec::new(),
            copies: Vec::new(),
            decoder: Decoder::new(),
            encoder: Encoder::new(),
        }
    }

    fn run(
        &mut self,
        mut from: &TcpStream,
        to: &TcpStream,
        way: usize,
        still: &[Mutex<Instant>; 2],
        ended: &AtomicBool,
    ) -> io::Result<()> {
        let mut bytes = [0; 4096];
        loop {
            let read = match from.read(&mut bytes) {
                Ok(0) => return Ok(()),
                Ok(read) => read,
                Err(error) if is_timeout(&error) => 0,
                Err(error) => return Err(error),
            };
            if ended.load(Ordering::Relaxed) {
                return Ok(());
            }
            let mut rest = &bytes[..read];
            while !rest.is_empty() {
                let (now, later) = rest.split_at(self.until_stall(rest.len()));
                wait_until(*still[way].lock().unwrap(), ended);
                write_all(to, &self.pass(now), ended)?;
                self.stall(now.len(), way, still);
                rest = later;
            }
        }
    }

    fn until_stall(&self, length: usize) -> usize {
        match self.suffers {
            Suffers::Stalls { every, .. } => length.min(every - self.since),
            _ => length,
        }
    }

    fn stall(&mut self, passed: usize, way: usize, still: &[Mutex<Instant>; 2]) {
        let Suffers::Stalls { every, time, both } = self.suffers else { return };
        self.since += passed;
        if self.since == every {
            self.since = 0;
            let until = Instant::now() + time;
            *still[way].lock().unwrap() = until;
            if both {
                *still[1 - way].lock().unwrap() = until;
            }
        }
    }

    /// The bytes that are passed on for `bytes`.
    fn pass(&mut self, bytes: &[u8]) -> Vec<u8> {
        match self.suffers {
            Suffers::Nothing | Suffers::Stalls { .. } => bytes.to_vec(),
            Suffers::Forges => self.forge(bytes),
            Suffers::Loses { .. } | Suffers::Repeats { .. } => self.packets(bytes),
        }
    }

    fn packets(&mut self, bytes: &[u8]) -> Vec<u8> {
        let mut out = Vec::new();
        for &byte in bytes {
            if byte != 0 {
                self.packet.push(byte);
            } else if !self.packet.is_empty() {
                let packet = std::mem::take(&mut self.packet);
                self.end(packet, &mut out);
            }
        }
        out
    }

    fn end(&mut self, packet: Vec<u8>, out: &mut Vec<u8>) {
        let mut send = |packet: &[u8]| {
            out.push(0);
            out.extend_from_slice(packet);
            out.push(0);
        };
        match self.suffers {
            Suffers::Loses { least, rate } if packet.len() >= least && self.dice.comes_up(rate) => {}
            Suffers::Repeats { later, rate } => {
                send(&packet);
                if self.dice.comes_up(rate) {
                    self.copies.push((later + 1, packet));
                }
            }
            _ => send(&packet),
        }
        self.copies.iter_mut().for_each(|(left, _)| *left -= 1);
        while let Some(due) = self.copies.iter().position(|(left, _)| *left == 0) {
            send(&self.copies.remove(due).1);
        }
    }

    fn forge(&mut self, bytes: &[u8]) -> Vec<u8> {
        let (mut rest, mut out) = (bytes, Vec::new());
        while let Some(packet) = self.decoder.next(&mut rest) {
            let Ok(packet) = packet else { continue };
            let mut packet = Passing { header: packet.header, payload: packet.payload.to_vec() };
            if let Some(Reply::RowOut(row)) = packet.reply() {
                let mut packed = row.packed.to_vec();
                packed.last_mut().into_iter().for_each(|byte| *byte ^= 1);
                packet = packet.saying(&Reply::RowOut(RowOut { packed: &packed, ..row }));
            }
            self.encoder.encode(&packet.header, |out| out.extend(&packet.payload), &mut out).unwrap();
        }
        out
    }
}

fn is_timeout(error: &io::Error) -> bool {
    matches!(error.kind(), io::ErrorKind::WouldBlock | io::ErrorKind::TimedOut)
}

/// Writes all of `bytes`, unless it ends before the other side has taken them.
fn write_all(mut to: &TcpStream, mut bytes: &[u8], ended: &AtomicBool) -> io::Result<()> {
    while !bytes.is_empty() && !ended.load(Ordering::Relaxed) {
        match to.write(bytes) {
            Ok(0) => return Err(io::ErrorKind::WriteZero.into()),
            Ok(written) => bytes = &bytes[written..],
            Err(error) if is_timeout(&error) => {}
            Err(error) => return Err(error),
        }
    }
    Ok(())
}

fn wait_until(until: Instant, ended: &AtomicBool) {
    while !ended.load(Ordering::Relaxed)
        && let Some(left) = until.checked_duration_since(Instant::now())
    {
        std::thread::sleep(left.min(TICK));
    }
}
