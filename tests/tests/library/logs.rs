//! The log of two runs at the same time.

use std::io::{self, Write};
use std::sync::{Arc, Mutex};
use std::thread;

use halfrow_tests::system::System;
use tracing_subscriber::util::SubscriberInitExt as _;

/// What was logged.
#[derive(Clone, Default)]
struct Log(Arc<Mutex<Vec<u8>>>);

impl Write for Log {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.0.lock().unwrap().extend_from_slice(bytes);
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

#[test]
fn every_line_of_two_runs_at_once_says_which_board_it_is_about() {
    let _alone = crate::RUNS.lock();
    let (log, boards) = (Log::default(), ["mock,fault=flip,packet=20", "mock,speed=1000000"]);
    thread::scope(|scope| {
        for board in boards {
            let writer = log.clone();
            let subscriber = tracing_subscriber::fmt()
                .with_max_level(tracing_subscriber::filter::LevelFilter::DEBUG)
                .with_writer(move || writer.clone())
                .with_ansi(false);
            scope.spawn(move || {
                let _heard = subscriber.finish().set_default();
                System::TINY.judge_at(board)
            });
        }
    });
    let log = String::from_utf8(log.0.lock().unwrap().clone()).unwrap();
    let of =
        |board: &str| log.lines().filter(|line| line.contains(&format!(" run{{board={board}}}: "))).count();
    for board in boards {
        assert!(of(board) > 0, "{board}: {log}");
    }
    let lines: Vec<_> = log.lines().filter(|line| line.contains(" halfrow::")).collect();
    let nameless: Vec<_> = lines.iter().filter(|line| !line.contains(" run{board=")).collect();
    assert!(nameless.is_empty(), "{nameless:#?}");
    // Only one of the two links damages what it carries, and only that run's lines say so.
    let damaged = lines.iter().filter(|line| line.contains("damaged"));
    assert!(damaged.clone().count() > 0 && damaged.clone().all(|line| line.contains(boards[0])), "{log}");
}
