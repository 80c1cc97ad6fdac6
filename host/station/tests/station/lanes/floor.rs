//! A station in its own folder, and its program at work.

use std::fs;
use std::io::{BufRead as _, BufReader, Write as _};
use std::path::PathBuf;
use std::process::{ChildStdin, Command, Stdio};
use std::sync::mpsc::{self, Receiver};
use std::thread;

use serde_json::Value;
use tempfile::TempDir;

use crate::common::{self, Killed};

pub(crate) use crate::common::{HANG, SERIALS};

/// A plan whose serial numbers are [`SERIALS`].
pub(crate) fn plan() -> String {
    common::guarded_plan("CAM-T", "CA")
}

/// A folder with settings.
pub(crate) struct Station {
    folder: TempDir,
}

impl Station {
    /// A station with a lane for each of these boards, named 1, 2, and so on, followed by more settings.
    pub(crate) fn with(boards: &[&str], more: &str) -> Self {
        let station = Self { folder: common::folder() };
        fs::write(station.path("plan.toml"), plan()).unwrap();
        let lanes = boards.iter().zip(1..).map(|(board, name)| {
            format!("[[lane]]\nname = \"{name}\"\nboard = \"{board}\"\nplans = [\"plan.toml\"]\n")
        });
        let lanes: String = lanes.collect();
        let text =
            format!("schema = 1\n[station]\nname = \"12\"\ndata = \"data\"\nsilence = 60\n{lanes}{more}");
        fs::write(station.path("station.toml"), text).unwrap();
        station
    }

    /// With lanes that may be silent only for so many seconds.
    pub(crate) fn with_silence(self, seconds: u32) -> Self {
        common::instead(self.path("station.toml"), "silence = 60", &format!("silence = {seconds}"));
        self
    }

    pub(crate) fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    /// Starts the station.
    pub(crate) fn start(&self) -> Running {
        self.started(Command::new(common::program()))
    }

    /// Starts the station, whose log goes to the file that is returned with it.
    pub(crate) fn start_logging(&self) -> (Running, PathBuf) {
        let log = self.path("log");
        let mut logging = Command::new("sh");
        logging.args(["-c", "exec \"$0\" \"$@\" 2>\"$LOG\""]).arg(common::program()).env("LOG", &log);
        (self.started(logging), log)
    }

    /// Starts the station by this call of its program.
    pub(crate) fn started(&self, mut program: Command) -> Running {
        program.args(["lanes", "--operator", "weber", "--settings"]).arg(self.path("station.toml"));
        program.stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::inherit());
        let mut child = Killed(program.spawn().unwrap());
        let (sender, news) = mpsc::channel();
        let stdout = BufReader::new(child.stdout.take().unwrap());
        thread::spawn(move || {
            for line in stdout.lines() {
                let _ = sender.send(serde_json::from_str(&line.unwrap()).unwrap());
            }
        });
        Running { stdin: child.stdin.take(), child, news, heard: Vec::new() }
    }

    /// Changes the database without the program; returns how many rows the last statement changed.
    pub(crate) fn change(&self, text: &str) -> usize {
        common::change(&self.path("data"), text)
    }

    /// Reads the database without the program: the first value of each row.
    pub(crate) fn query(&self, text: &str) -> Vec<String> {
        common::query(&self.path("data"), text)
    }

    /// Asserts that everything it stored is as it was written.
    pub(crate) fn assert_well(&self) {
        let did = common::check(&self.path("data"));
        assert_eq!(did.code, Some(0), "{did:?}");
    }
}

/// The program at work.
pub(crate) struct Running {
    child: Killed,
    stdin: Option<ChildStdin>,
    news: Receiver<Value>,
    /// All news so far.
    pub(crate) heard: Vec<Value>,
}

impl Running {
    pub(crate) fn scan(&mut self, text: &str) {
        writeln!(self.stdin.as_mut().unwrap(), "{text}").unwrap();
    }

    /// Scans bytes that need not be text.
    pub(crate) fn scan_bytes(&mut self, bytes: &[u8]) {
        self.stdin.as_mut().unwrap().write_all(&[bytes, b"\n"].concat()).unwrap();
    }

    /// Scans the lane's barcode and the serial number.
    pub(crate) fn test(&mut self, lane: &str, serial: &str) {
        self.scan(&format!("HR:LANE:{lane}"));
        self.scan(serial);
    }

    /// Waits for the next piece of news that is wanted.
    pub(crate) fn wait(&mut self, what: &str, is_wanted: impl Fn(&Value) -> bool) -> Value {
        loop {
            let news = self.news.recv_timeout(HANG);
            let news = news.unwrap_or_else(|_| panic!("no {what}; heard {:#?}", self.heard));
            self.heard.push(news.clone());
            if is_wanted(&news) {
                return news;
            }
        }
    }

    /// Waits for the lane to be in this state.
    pub(crate) fn state(&mut self, lane: &str, state: &str) -> Value {
        self.wait(&format!("{state} in lane {lane}"), |news| {
            news["news"] == "lane" && news["lane"] == lane && news["state"] == state
        })
    }

    /// Waits for the answer to a scan: whether it was accepted, and what was said.
    pub(crate) fn answer(&mut self, scanned: &str) -> (bool, String) {
        let answer = self.wait(&format!("answer to {scanned}"), |news| {
            news["news"] == "scan" && news["scanned"] == scanned
        });
        (answer["is_taken"].as_bool().unwrap(), answer["said"].as_str().unwrap().to_owned())
    }

    /// Its process id.
    pub(crate) fn id(&self) -> u32 {
        self.child.id()
    }

    /// Ends the scans; returns the exit code and all news.
    pub(crate) fn end(mut self) -> (Option<i32>, Vec<Value>) {
        drop(self.stdin.take());
        let status = self.child.wait().unwrap();
        self.heard.extend(self.news.iter());
        (status.code(), self.heard)
    }
}
