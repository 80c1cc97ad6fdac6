//! A served board keeps real time, and a silent host does not keep it from others.

use std::io::{ErrorKind, Read, Write};
use std::net::TcpStream;
use std::os::unix::net::UnixStream;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex};
use std::time::Duration;

use halfrow_protocol::message::{Hello, RefusalCode, Reply};
use halfrow_protocol::{Decoder, Encoder, Header, Request};

use super::tcp::Patience;
use super::{Hosted, Left, Port};
use halfrow::link::descriptor::never_block;
use halfrow::link::{Link, LinkError, open};

/// A link whose clock can be set ahead.
struct Shifted {
    link: Box<dyn Link>,
    by: Arc<Mutex<Duration>>,
}

impl Link for Shifted {
    fn exchange(
        &mut self,
        outgoing: &[u8],
        incoming: &mut Vec<u8>,
        wait: Duration,
    ) -> Result<usize, LinkError> {
        self.link.exchange(outgoing, incoming, wait)
    }

    fn now(&self) -> Duration {
        self.link.now() + *self.by.lock().unwrap()
    }

    fn bytes_per_second(&self) -> Option<f64> {
        self.link.bytes_per_second()
    }

    fn name(&self) -> String {
        self.link.name()
    }
}

fn mock() -> Box<dyn Link> {
    open(&"mock".parse().unwrap()).unwrap().link
}

/// The HELLO of a host.
fn hello(host: u32) -> Vec<u8> {
    let hello = Hello { nonce: host, host, version_min: 1, version_max: 1, take_over: false };
    let request = Request::Hello(hello);
    let header = Header { kind: request.kind().code(), ..Header::default() };
    let mut bytes = Vec::new();
    Encoder::new().encode(&header, |payload| request.write(payload), &mut bytes).unwrap();
    bytes
}

/// Why the board turned a host away, if it did.
fn refusal(mut bytes: &[u8]) -> Option<RefusalCode> {
    let mut decoder = Decoder::new();
    let packet = decoder.next(&mut bytes).unwrap().unwrap();
    match Reply::read(&packet).unwrap() {
        Reply::Refusal(refusal) => Some(refusal.code),
        Reply::Hello(_) => None,
        other => unreachable!("{other:?}"),
    }
}

/// The refusal that a second host gets when the first one, which is gone, was last heard this long `ago`.
fn second_host_is_told(ago: Duration) -> Option<RefusalCode> {
    let mut link = mock();
    let mut heard = Vec::new();
    link.exchange(&hello(1), &mut heard, Duration::ZERO).unwrap();
    assert_eq!(refusal(&heard), None);
    // The board was switched on this long ago, and its clock has stood still since.
    let by = Arc::new(Mutex::new(ago));
    let mut board = Hosted::new(Box::new(Shifted { link, by: Arc::clone(&by) }));
    *by.lock().unwrap() = Duration::ZERO;
    let (mut host, door) = UnixStream::pair().unwrap();
    never_block(std::os::fd::AsRawFd::as_raw_fd(&door)).unwrap();
    host.write_all(&hello(2)).unwrap();
    assert_eq!(board.attend(&door, &mut |traffic| traffic.to_host > 0).unwrap(), Left::Ended);
    let mut told = [0; 4096];
    let length = host.read(&mut told).unwrap();
    refusal(&told[..length])
}

#[test]
fn a_board_whose_link_is_paced_is_paced_once() {
    let hosted = Hosted::open(&"mock,pace=real,speed=1000".parse().unwrap()).unwrap();
    assert_eq!(hosted.link.name(), "the mock board's simulated link (1000 bytes/s, simulated time)");
}

#[test]
fn a_host_that_was_silent_while_nobody_was_served_holds_the_board_no_longer() {
    assert_eq!(second_host_is_told(Duration::from_secs(15)), None);
    assert_eq!(second_host_is_told(Duration::from_secs(1)), Some(RefusalCode::Held));
}

/// What the port sends to a host while another one is connected that has sent `first`.
fn told_beside(first: &[u8], patience: Patience) -> Vec<u8> {
    let mut port = Port::listen(&"127.0.0.1:0".parse().unwrap()).unwrap();
    port.patience = patience;
    let address = port.address().unwrap();
    let done = Arc::new(AtomicBool::new(false));
    let is_done = Arc::clone(&done);
    let server = std::thread::spawn(move || {
        port.serve(&mut Hosted::new(mock()), &mut |_| is_done.load(Ordering::Relaxed)).unwrap();
    });
    let mut holder = TcpStream::connect(address).unwrap();
    holder.write_all(first).unwrap();
    if !first.is_empty() {
        assert_ne!(holder.read(&mut [0; 4096]).unwrap(), 0);
    }
    let mut second = TcpStream::connect(address).unwrap();
    second.write_all(&hello(1)).unwrap();
    let mut told = vec![0; 4096];
    let length = second.read(&mut told).unwrap();
    told.truncate(length);
    holder.set_nonblocking(true).unwrap();
    let still_there = holder.read(&mut [0; 1]).map_err(|error| error.kind()) == Err(ErrorKind::WouldBlock);
    assert_eq!(still_there, told.starts_with(b"Port"), "one of the two is served");
    done.store(true, Ordering::Relaxed);
    server.join().unwrap();
    told
}

#[test]
fn a_host_that_says_nothing_gives_way_and_one_that_speaks_does_not() {
    let never = Duration::from_secs(3600);
    let impatient = Patience { unheard: Duration::ZERO, silent: never };
    assert_eq!(refusal(&told_beside(&[], impatient)), None);
    assert_eq!(told_beside(&hello(1), impatient), b"Port already in use\r\n");
    let at_once = Patience { unheard: never, silent: Duration::ZERO };
    assert_eq!(refusal(&told_beside(&hello(1), at_once)), None);
}
