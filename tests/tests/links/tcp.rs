//! TCP, with nothing in between.

use std::io::{Read as _, Write as _};
use std::net::{TcpListener, TcpStream};
use std::sync::mpsc::{RecvTimeoutError, Sender, channel};
use std::time::Duration;

use halfrow::link::LinkError;
use halfrow_tests::not_tested::not_tested;
use halfrow_tests::patience::{LIMIT, come_to_an_end};
use halfrow_tests::proxy::{Proxy, Suffers};
use halfrow_tests::served::Served;

use crate::{ends, passes, verify};

#[test]
fn a_board_behind_a_tcp_port_passes_again_and_again() {
    let served = Served::on_a_tcp_port("127.0.0.1", "mock");
    passes(&served);
    passes(&served);
    verify(&format!("{},baud=12000000", served.target()), &[]).succeeded();
}

/// Ten bits a byte: a start bit, eight bits, a stop bit.
#[test]
fn the_rate_of_the_line_at_the_far_end_is_that_of_the_link() {
    let listener = TcpListener::bind("127.0.0.1:0").unwrap();
    for (option, rate) in [("", None), (",baud=9600", Some(960.0))] {
        let target = format!("tcp:{}{option}", listener.local_addr().unwrap());
        let candidate = halfrow::link::open(&target.parse().unwrap()).unwrap();
        assert_eq!(candidate.link.bytes_per_second(), rate, "{target}");
    }
}

#[test]
fn a_board_behind_an_ipv6_port_passes() {
    if TcpListener::bind("[::1]:0").is_err() {
        not_tested("a board behind an IPv6 port", "this computer has no IPv6");
        return;
    }
    let served = Served::on_a_tcp_port("[::1]", "mock");
    assert!(served.target().starts_with("tcp:[::1]:"), "{}", served.target());
    passes(&served);
}

#[test]
fn ports_that_lead_nowhere_are_told_apart() {
    let listener = TcpListener::bind("127.0.0.1:0").unwrap();
    // The near end of a connection: nothing listens there, and while the connection lasts nothing else can.
    let near = TcpStream::connect(listener.local_addr().unwrap()).unwrap();
    ends(
        &verify(&format!("tcp:{}", near.local_addr().unwrap()), &[]),
        3,
        "refuses connections: the host is there, and nothing listens",
    );
    ends(
        &verify("tcp:no-such-host.invalid:3001", &[]),
        3,
        "the host of `no-such-host.invalid:3001` is not known",
    );
    ends(&verify("tcp:localhost", &[]), 2, "`localhost` is no host and port");
    ends(&verify("tcp", &[]), 2, "write tcp:HOST:PORT");
    ends(&verify("tcp:localhost:1,rate=5", &[]), 2, "`rate=5` is not an option of `tcp`");
}

#[test]
fn a_server_that_hangs_up_is_an_error() {
    let listener = TcpListener::bind("127.0.0.1:0").unwrap();
    let target = format!("tcp:{}", listener.local_addr().unwrap());
    let server = std::thread::spawn(move || drop(listener.accept().unwrap()));
    ends(&verify(&target, &[]), 3, "by the program at its far end: it was ended");
    server.join().unwrap();
}

#[test]
fn a_line_that_echoes_is_no_board_with_a_wrong_bitstream() {
    let listener = TcpListener::bind("127.0.0.1:0").unwrap();
    let target = format!("tcp:{}", listener.local_addr().unwrap());
    let server = std::thread::spawn(move || {
        let mut host = listener.accept().unwrap().0;
        let mut back = host.try_clone().unwrap();
        std::io::copy(&mut host, &mut back)
    });
    ends(&verify(&target, &[]), 3, "the line returns what is sent to it");
    server.join().unwrap().unwrap();
}

#[test]
fn a_server_that_speaks_in_words_is_quoted() {
    // A message that is cut within a character, and messages of ser2net, such as that another program has its device.
    let long = format!("{}é no board here", "a".repeat(199));
    for (words, code, sentence) in [
        (long.as_str(), 3, "aaa` and no board"),
        ("Device open failure: Object was already in use\r\n", 4, "another host is connected"),
        ("Device open failure: Value or file not found\r\n", 3, "plug the board in at the far end"),
        ("Port already in use\r\n", 4, "another host is connected"),
        ("SSH-2.0-OpenSSH_9.2\r\n", 3, "answered with the words `SSH-2.0-OpenSSH_9.2` and no board"),
    ] {
        let listener = TcpListener::bind("127.0.0.1:0").unwrap();
        let target = format!("tcp:{}", listener.local_addr().unwrap());
        let words = words.as_bytes().to_owned();
        let server = std::thread::spawn(move || {
            let mut host = listener.accept().unwrap().0;
            host.write_all(&words).unwrap();
        });
        let ended = verify(&target, &[]);
        ends(&ended, code, sentence);
        // It is no link that broke, and nobody is sent to look for a cable.
        let of_words = if code == 4 { "link-in-use" } else { "link-without-board" };
        assert_eq!(ended.json()["finding"]["code"], of_words, "{}", ended.stdout);
        assert!(!ended.headline().contains("the link broke"), "{}", ended.headline());
        server.join().unwrap();
    }
}

/// As a server that greets with its terms of use, or a board that tells how it boots.
#[test]
fn a_board_behind_a_long_greeting_that_goes_away_was_there() {
    let listener = TcpListener::bind("127.0.0.1:0").unwrap();
    let target = format!("tcp:{}", listener.local_addr().unwrap());
    let server = std::thread::spawn(move || {
        let mut host = listener.accept().unwrap().0;
        for bytes in [&[b'a'; 200], &hello()[..]] {
            host.write_all(bytes).unwrap();
            // The host must take these bytes alone.
            host.read_exact(&mut [0]).unwrap();
        }
    });
    let mut link = halfrow::link::open(&target.parse().unwrap()).unwrap().link;
    let mut came = Vec::new();
    let lost = loop {
        let before = came.len();
        if let Err(lost) = link.exchange(&[], &mut came, LIMIT) {
            break lost;
        }
        if came.len() > before && [200, 200 + hello().len()].contains(&came.len()) {
            link.exchange(&[0], &mut came, LIMIT).unwrap();
        }
    };
    assert!(matches!(lost, LinkError::ClosedAfar { .. }), "{lost}");
    server.join().unwrap();
}

/// The HELLO among the frozen packets.
fn hello() -> Vec<u8> {
    let text = include_str!("../../../protocol/vectors/hello-request.hex");
    let bytes = text.lines().flat_map(|line| line.split("//").next().unwrap_or_default().split_whitespace());
    bytes.map(|byte| u8::from_str_radix(byte, 16).unwrap()).collect()
}

#[test]
fn a_second_host_is_turned_away_while_a_first_is_connected() {
    let served = Served::on_a_tcp_port("127.0.0.1", "mock");
    let mut first = TcpStream::connect(served.address()).unwrap();
    let hello = hello();
    let (stop, stopped) = channel::<()>();
    std::thread::scope(|scope| {
        let stop: Sender<()> = stop;
        // A host that sends something now and then, and reads what comes back.
        let first = &mut first;
        let hello = &hello;
        scope.spawn(move || {
            while stopped.recv_timeout(Duration::from_millis(100)) == Err(RecvTimeoutError::Timeout) {
                first.write_all(hello).unwrap();
                assert_ne!(first.read(&mut [0; 4096]).unwrap(), 0, "the first host is served on");
            }
        });
        ends(&verify(&served.target(), &[]), 4, "another host is connected");
        drop(stop);
    });
    drop(first);
    // The first host greeted the board, so it holds it for another ten seconds.
    verify(&served.target(), &["--take-over"]).succeeded();
}

#[test]
fn a_proxy_ends_although_nobody_takes_what_it_passes_on() {
    let board = TcpListener::bind("127.0.0.1:0").unwrap();
    let address = board.local_addr().unwrap().to_string();
    let proxy = Proxy::before(&address, Suffers::Nothing, Suffers::Nothing, 1);
    let mut host = TcpStream::connect(proxy.target().trim_start_matches("tcp:")).unwrap();
    let (mut board, _) = board.accept().unwrap();
    for end in [&mut host, &mut board] {
        end.set_write_timeout(Some(Duration::from_millis(100))).unwrap();
        while end.write(&[0; 1 << 16]).is_ok() {}
    }
    come_to_an_end(move || drop(proxy));
}

/// RFC 5737: nobody has this address.
#[test]
#[should_panic(expected = "no board is served: Some(Err(Door")]
fn a_server_that_cannot_begin_says_why() {
    drop(Served::on_a_tcp_port("192.0.2.1", "mock"));
}
