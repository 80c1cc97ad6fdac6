//! Serial ports: set up, locked, drained, and never waited for beyond a deadline.

use std::fs::{self, OpenOptions};
use std::io::Write as _;
use std::os::fd::AsRawFd;
use std::time::{Duration, Instant};

use halfrow::link::{self, Class, SerialError};
use halfrow_cli::serve::Pty;
use halfrow_tests::patience::{LIMIT, come_to_an_end, wait_until};
use halfrow_tests::program::halfrow;
use halfrow_tests::served::Served;
use nix::poll::{PollFd, PollFlags, poll};

use crate::{ends, once_free, passes, verify};

#[test]
fn a_board_behind_a_serial_port_passes_again_and_again() {
    let served = Served::on_a_serial_port("mock");
    passes(&served);
    passes(&served);
    let info = halfrow(["info", "--json", "--board", &served.target()]);
    assert_eq!(info.json()["board"]["kind"], "mock", "{}", info.stderr);
}

#[test]
fn a_pseudo_terminal_takes_every_rate() {
    for baud in [9600, 115_200, 7_000_000, 12_000_000] {
        let served = Served::on_a_serial_port("mock");
        let ended =
            verify(&format!("{},baud={baud},flow=none,dtr=off,rts=off", served.target()), &[]).succeeded();
        assert!(ended.json()["link"]["name"].as_str().unwrap().contains(&format!("({baud} baud)")));
    }
}

#[test]
fn a_port_that_is_not_there_is_an_error_of_the_station() {
    ends(
        &verify("serial:/dev/ttyUSB99", &[]),
        3,
        "there is no serial port /dev/ttyUSB99; check that the board is plugged in",
    );
    // Paths that other programs accept as ports.
    ends(&verify("serial:null", &[]), 3, "there is no serial port null; write serial:/dev/null, or check");
    ends(&verify("serial:/dev/null", &[]), 2, "/dev/null is no serial port");
    ends(&verify("serial:/etc/passwd", &[]), 2, "/etc/passwd is no serial port");
    ends(&verify("serial", &[]), 2, "write serial:PATH");
    ends(&verify("serial:/dev/ttyUSB99,baud=much", &[]), 2, "`baud=much` is not an option of `serial`");
}

#[test]
fn a_port_is_set_as_the_board_that_is_named_needs_it() {
    let served = Served::on_a_serial_port("mock");
    let ended = verify(&format!("{},board=ulx3s", served.target()), &[]).succeeded();
    assert!(ended.json()["link"]["name"].as_str().unwrap().contains("(3000000 baud)"), "{}", ended.stdout);
    let contradicts = verify("serial:/dev/ttyUSB99,board=ulx3s,baud=115200", &[]);
    ends(&contradicts, 2, "`baud=115200` contradicts `board=ulx3s`, which means baud=3000000,flow=none");
    let unknown = verify("serial:/dev/ttyUSB99,board=ulx4s", &[]);
    ends(&unknown, 2, "it takes board=minispartan6plus or board=ulx3s, baud=RATE");
}

#[test]
fn a_port_in_use_is_busy_until_it_is_closed() {
    let served = Served::on_a_serial_port("mock");
    let held = link::open(&served.target().parse().unwrap()).unwrap();
    let busy = verify(&served.target(), &[]);
    ends(&busy, 4, "is in use by links");
    assert_eq!(busy.json()["verdict"], "ERROR");
    drop(held);
    once_free(|| verify(&served.target(), &[]), |ended| ended.code == Some(4)).succeeded();
}

/// Nobody can close another program when this one is meant.
#[test]
fn a_port_that_this_program_has_open_is_not_said_to_be_another_s() {
    let served = Served::on_a_serial_port("mock");
    let target = served.target().parse().unwrap();
    let _held = link::open(&target).unwrap();
    let refused = link::open(&target).err().unwrap().to_string();
    let own = format!("(process {}), which is this very program; wait until", std::process::id());
    assert!(refused.contains("is in use by links") && refused.contains(&own), "{refused}");
}

/// Waits until the kernel has carried what was written at one end of a pseudo-terminal to `end`, which takes it some time.
fn wait_for_bytes(end: &impl AsRawFd) {
    let ready = poll(&mut [PollFd::new(end.as_raw_fd(), PollFlags::POLLIN)], LIMIT.as_millis() as i32);
    assert_eq!(ready, Ok(1));
}

#[test]
fn stale_bytes_are_dropped() {
    let served = Served::on_a_serial_port("mock");
    // A host that asked for much and never read it: the end of a greeting, then answers without a question.
    let mut rude = OpenOptions::new().read(true).write(true).open(served.address()).unwrap();
    rude.write_all(&[0; 100]).unwrap();
    rude.write_all(b"\x05halfrow\x00\x11\x22").unwrap();
    drop(rude);
    passes(&served);
    // A board that has been sending while nobody listened.
    let pty = Pty::open().unwrap();
    let say = |bytes: &[u8]| assert_eq!(nix::unistd::write(pty.as_raw_fd(), bytes), Ok(bytes.len()));
    say(&[0x55; 3000]);
    wait_for_bytes(&OpenOptions::new().read(true).write(true).open(pty.path()).unwrap());
    let mut link = link::open(&format!("serial:{}", pty.path().display()).parse().unwrap()).unwrap().link;
    let mut incoming = Vec::new();
    link.exchange(&[], &mut incoming, Duration::from_millis(10)).unwrap();
    assert_eq!(incoming, b"");
    say(b"new");
    link.exchange(&[], &mut incoming, LIMIT).unwrap();
    assert_eq!(incoming, b"new");
    link.exchange(b"answer", &mut incoming, LIMIT).unwrap();
    wait_for_bytes(&pty);
    let mut answer = [0; 6];
    assert_eq!(nix::unistd::read(pty.as_raw_fd(), &mut answer), Ok(6));
    assert_eq!(&answer, b"answer");
}

#[test]
fn a_peer_that_takes_nothing_holds_nobody_up() {
    let pty = Pty::open().unwrap();
    let target = format!("serial:{}", pty.path().display());
    let opened = target.parse().unwrap();
    let taken = come_to_an_end(move || {
        let mut link = link::open(&opened).unwrap().link;
        let mut taken = 0;
        for _ in 0..20 {
            taken += link.exchange(&[0x55; 100_000], &mut Vec::new(), Duration::from_millis(20)).unwrap();
        }
        // Nor does closing it wait for what was never accepted.
        drop(link);
        taken
    });
    assert!((1000..1_000_000).contains(&taken), "{taken}");
    let silent = verify(&target, &[]);
    ends(&silent, 3, "no answer to HELLO in 6 tries");
}

#[test]
fn a_port_that_hangs_up_says_so_at_once() {
    let pty = Pty::open().unwrap();
    let mut link = link::open(&format!("serial:{}", pty.path().display()).parse().unwrap()).unwrap().link;
    let this_thread = fs::canonicalize("/proc/thread-self").unwrap();
    let hanging_up = std::thread::spawn(move || {
        let asleep = || fs::read_to_string(this_thread.join("stat")).unwrap().contains(") S ");
        wait_until("the link to wait", asleep);
        drop(pty);
    });
    let begun = Instant::now();
    let gone = link.exchange(&[], &mut Vec::new(), LIMIT).unwrap_err();
    assert!(begun.elapsed() < LIMIT);
    assert!(gone.to_string().contains("the board was unplugged or lost power"), "{gone}");
    let again = link.exchange(b"x", &mut Vec::new(), LIMIT).unwrap_err();
    assert!(again.to_string().contains("the board was unplugged"), "{again}");
    hanging_up.join().unwrap();
}

#[test]
fn what_the_errors_of_serial_ports_mean_to_scripts() {
    let path = std::path::PathBuf::from("/dev/ttyUSB1");
    let (chip, nearest) = ("a high-speed FTDI chip", vec![6_000_000, 12_000_000]);
    let rate = SerialError::Rate { path, chip, baud: 7_000_000, nearest };
    assert_eq!(
        rate.to_string(),
        "a high-speed FTDI chip, which is behind /dev/ttyUSB1, cannot make 7000000 baud; the nearest that it makes: \
         6000000 and 12000000"
    );
    assert_eq!(rate.class(), Class::Call);
}
