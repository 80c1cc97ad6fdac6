//! A station that serves its pages.

use std::fs::{self, File};
use std::io::{BufRead as _, BufReader, Read as _, Seek as _};
use std::os::fd::AsRawFd as _;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Output, Stdio};
use std::thread;

use nix::sys::signal::Signal;
use tempfile::TempDir;

use super::http::{Request, Response, escaped};
pub(crate) use crate::common::SERIALS;
use crate::common::{self, guarded_plan, instead, program, until_found};

/// The name under which browsers reach a station that others can reach.
pub(crate) const PUBLIC: &str = "station12.example";

/// The accounts of a station that has some: name, role, badge, password.
const PEOPLE: [(&str, &str, &str, &str); 2] =
    [("Weber", "operator", "A-0017", ""), ("Braun", "engineer", "B-0022", "correct horse")];

/// A folder with a station's settings.
pub(crate) struct Station {
    folder: TempDir,
}

impl Station {
    /// A station with this many mock boards, with more settings before them.
    pub(crate) fn with(lanes: usize, more: &str) -> Self {
        let station = Self { folder: common::folder() };
        let plan = guarded_plan("CAM-T", "CA").replace("if-present", "not-checked");
        fs::write(station.path("plan.toml"), plan).unwrap();
        let lane = |name| {
            format!("[[lane]]\nname = \"{name}\"\nboard = \"mock,serial={name}\"\nplans = [\"plan.toml\"]\n")
        };
        let lanes: String = (1..=lanes).map(lane).collect();
        let text = format!("schema = 1\n[station]\nname = \"12\"\ndata = \"data\"\n{more}\n{lanes}");
        fs::write(station.path("station.toml"), text).unwrap();
        station
    }

    /// A station used at its own computer, where nobody logs in.
    pub(crate) fn private(lanes: usize) -> Self {
        Self::with(lanes, "[web]\nlisten = \"127.0.0.1:0\"")
    }

    /// A station behind a proxy that speaks TLS, where people log in.
    pub(crate) fn public(lanes: usize) -> Self {
        let web = format!("[web]\nlisten = \"127.0.0.1:0\"\npublic = \"https://{PUBLIC}\"");
        let station =
            Self::with(lanes, &format!("{web}\n[access]\nusers = \"users.toml\"\ntokens = \"tokens.toml\""));
        for (name, role, badge, password) in PEOPLE {
            let added = station.user(&["add", name, "--role", role], &format!("{badge}\n{password}\n"));
            assert!(added.status.success(), "{}", String::from_utf8_lossy(&added.stderr));
        }
        station
    }

    /// The station after a replacement in one of its files.
    pub(crate) fn where_instead(self, name: &str, was: &str, is: &str) -> Self {
        instead(self.path(name), was, is);
        self
    }

    /// The station, to be served at this port from now on, where a page knew an earlier one.
    pub(crate) fn at(self, port: u16) -> Self {
        self.where_instead("station.toml", "127.0.0.1:0", &format!("127.0.0.1:{port}"))
    }

    pub(crate) fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    /// `halfrow-station token`.
    pub(crate) fn token(&self, arguments: &[&str]) -> Output {
        self.secrets("token", arguments, "")
    }

    /// `halfrow-station user` with this on stdin.
    pub(crate) fn user(&self, arguments: &[&str], said: &str) -> Output {
        self.secrets("user", arguments, said)
    }

    fn secrets(&self, name: &str, arguments: &[&str], said: &str) -> Output {
        common::told(&mut common::command(self.folder.path(), &[&[name], arguments].concat()), said)
    }

    pub(crate) fn serve(&self) -> Serving {
        Serving::of(&mut self.command())
    }

    /// What `serve` prints when it refuses to start.
    pub(crate) fn refused(&self) -> String {
        let output = self.command().output().unwrap();
        assert_eq!(output.status.code(), Some(2));
        String::from_utf8(output.stderr).unwrap()
    }

    pub(crate) fn command(&self) -> Command {
        command(&self.path("station.toml"))
    }

    /// Changes the database without the program; returns how many rows the last statement changed.
    pub(crate) fn change(&self, text: &str) -> usize {
        common::change(&self.path("data"), text)
    }

    /// Reads the database without the program.
    pub(crate) fn query(&self, text: &str) -> Vec<String> {
        common::query(&self.path("data"), text)
    }

    /// Waits for a FAIL, and returns its run.
    pub(crate) fn until_failed(&self) -> String {
        until_found("a FAIL", || {
            let found = self.query("SELECT id FROM run WHERE verdict = 'FAIL'").pop();
            found.ok_or_else(|| self.query("SELECT verdict FROM run"))
        })
    }
}

/// The program that serves a station of these settings.
pub(crate) fn command(settings: &Path) -> Command {
    let mut command = Command::new(program());
    command.args(["serve", "--operator", "weber", "--settings"]).arg(settings);
    command
}

/// A running program that serves pages.
pub(crate) struct Serving {
    child: Child,
    /// Its stderr.
    complained: File,
    pub(crate) port: u16,
}

impl Serving {
    /// Starts `command`, and waits for the address of its pages.
    pub(crate) fn of(command: &mut Command) -> Self {
        loop {
            let complained = tempfile::tempfile().unwrap();
            let stderr = complained.try_clone().unwrap();
            let command = command.stdin(Stdio::null()).stdout(Stdio::piped()).stderr(stderr);
            let mut child = command.spawn().unwrap();
            let mut lines = BufReader::new(child.stdout.take().unwrap()).lines().map_while(Result::ok);
            let said = lines.find_map(|line| line.split("http://127.0.0.1:").nth(1).map(str::to_owned));
            if let Some(said) = said {
                // Its further output must not fill the pipe.
                thread::spawn(move || lines.for_each(drop));
                return Self { child, complained, port: said.trim_end_matches('/').parse().unwrap() };
            }
            let code = child.wait().unwrap().code();
            let why = whole(complained);
            // Processes that other tests are just starting briefly hold a store that this test has closed.
            assert_eq!(code, Some(4), "it does not say where its pages are: {why}");
        }
    }

    /// Sends the program a signal.
    pub(crate) fn signal(&self, signal: Signal) {
        common::signal(self.child.id(), signal);
    }

    /// Whether the program ignores this signal.
    pub(crate) fn ignores(&self, signal: Signal) -> bool {
        let status = fs::read_to_string(format!("/proc/{}/status", self.child.id())).unwrap();
        let ignored = status.lines().find_map(|line| line.strip_prefix("SigIgn:")).unwrap();
        u64::from_str_radix(ignored.trim(), 16).unwrap() >> (signal as i32 - 1) & 1 == 1
    }

    /// What it has printed on stderr so far.
    pub(crate) fn complained(&self) -> String {
        whole(File::open(format!("/proc/self/fd/{}", self.complained.as_raw_fd())).unwrap())
    }

    /// Whether the program still runs.
    pub(crate) fn is_alive(&mut self) -> bool {
        self.child.try_wait().unwrap().is_none()
    }

    /// Its exit code when `signal` stops it.
    pub(crate) fn stopped_by(mut self, signal: Signal) -> Option<i32> {
        self.signal(signal);
        self.child.wait().unwrap().code()
    }

    /// A browser that comes for the first time.
    pub(crate) fn browser(&self, host: &str) -> Browser {
        let mut browser =
            Browser { port: self.port, host: host.to_owned(), cookie: String::new(), csrf: String::new() };
        browser.learn(&browser.get("/login").send());
        browser
    }

    /// A browser on the station's own computer.
    pub(crate) fn here(&self) -> Browser {
        self.browser(&format!("127.0.0.1:{}", self.port))
    }

    /// A browser elsewhere, after a login.
    pub(crate) fn logged_in(&self, badge: &str, password: &str) -> Browser {
        let mut browser = self.browser(PUBLIC);
        let answer = browser.post("/login", &[("badge", badge), ("password", password)]).send();
        assert_eq!(answer.status, 303, "{}", answer.text());
        browser.learn(&answer);
        browser.learn(&browser.get("/").with("accept", "text/html").send());
        browser
    }

    pub(crate) fn operator(&self) -> Browser {
        self.logged_in("A-0017", "")
    }

    pub(crate) fn engineer(&self) -> Browser {
        self.logged_in("B-0022", "correct horse")
    }
}

impl Drop for Serving {
    // Shown when a test fails.
    #[allow(clippy::print_stdout)]
    fn drop(&mut self) {
        let ended = self.child.try_wait();
        let _ = self.child.kill();
        let _ = self.child.wait();
        if thread::panicking() {
            let said = self.complained.try_clone().map(whole);
            println!("the pages at port {} had ended: {ended:?}; they said: {said:?}", self.port);
        }
    }
}

/// The whole content of a file.
fn whole(mut file: File) -> String {
    let mut text = Vec::new();
    let read = file.rewind().and_then(|()| file.read_to_end(&mut text));
    read.map_or_else(|error| error.to_string(), |_| String::from_utf8_lossy(&text).into_owned())
}

/// The state that a browser keeps for a station.
#[derive(Clone, Debug)]
pub(crate) struct Browser {
    port: u16,
    host: String,
    pub(crate) cookie: String,
    csrf: String,
}

impl Browser {
    /// Keeps the cookie and the forms' token of an answer.
    pub(crate) fn learn(&mut self, answer: &Response) {
        if let Some(cookie) = answer.headers.get("set-cookie") {
            self.cookie = cookie.split(';').next().unwrap().to_owned();
        }
        if let Some(mark) = answer.text().split("name=\"csrf\" value=\"").nth(1) {
            self.csrf = mark.split('"').next().unwrap().to_owned();
        }
    }

    pub(crate) fn get(&self, path: &str) -> Request {
        let request = Request::bare(self.port, "GET", path).with("host", &self.host);
        if self.cookie.is_empty() { request } else { request.with("cookie", &self.cookie) }
    }

    /// A request with everything that a form of the station's own pages sends.
    pub(crate) fn post(&self, path: &str, fields: &[(&str, &str)]) -> Request {
        let scheme = if self.host == PUBLIC { "https" } else { "http" };
        let mut request = self.get(path).with("origin", &format!("{scheme}://{}", self.host));
        request.method = "POST".to_owned();
        let fields = fields.iter().copied().chain([("csrf", self.csrf.as_str())]);
        let pairs: Vec<_> = fields.map(|(name, value)| format!("{name}={}", escaped(value))).collect();
        Request { body: pairs.join("&"), ..request }
    }

    /// Lets `serial` be tested in `lane`, or wait there.
    pub(crate) fn scan(&self, serial: &str, lane: &str) {
        self.post("/scan", &[("text", serial), ("lane", lane)]).until_taken();
    }
}
