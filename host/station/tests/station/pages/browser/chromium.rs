//! Chromium without a window, over the pipes of its DevTools protocol: messages in JSON, each ended by a zero byte.

use std::io::{BufRead as _, BufReader, Write as _};
use std::process::{ChildStdin, Command, Stdio};
use std::sync::mpsc::{self, Receiver};
use std::thread;
use std::time::{Duration, Instant};

use serde_json::{Value, json};
use tempfile::TempDir;

use crate::common::{HANG, Killed};
use crate::pages::station::Serving;

/// How often a condition is checked.
const LOOK: Duration = Duration::from_millis(20);

/// The browser's descriptors 3 and 4 are its ends of the pipes.
const START: &str = "exec chromium --headless=new --no-sandbox --disable-gpu --no-first-run --disable-background-networking \
    --disable-component-update --disable-default-apps --disable-sync --disable-background-timer-throttling \
    --autoplay-policy=no-user-gesture-required --user-data-dir=\"$0\" --remote-debugging-pipe \"$@\" about:blank 3<&0 4>&1 >/dev/null 2>&1";

/// A browser with one page.
pub(super) struct Chromium {
    _child: Killed,
    to: ChildStdin,
    from: Receiver<Value>,
    session: Value,
    number: u64,
    /// The addresses of everything that the page requested.
    pub(super) asked: Vec<String>,
    _profile: TempDir,
}

impl Chromium {
    /// A browser with the page at `address`.
    pub(super) fn open(address: &str) -> Self {
        Self::with(&[], address)
    }

    /// A browser with the page of a station's lanes, as soon as it is live.
    pub(super) fn live(serving: &Serving) -> Self {
        let mut page = Self::open(&format!("http://127.0.0.1:{}/", serving.port));
        page.wait("document.getElementById('lamp')?.textContent === 'live'");
        page
    }

    /// A browser with further arguments, with the page at `address`.
    pub(super) fn with(arguments: &[&str], address: &str) -> Self {
        let profile = tempfile::tempdir().unwrap();
        let mut command = Command::new("sh");
        command.args(["-c", START]).arg(profile.path()).args(arguments);
        let mut child = Killed(command.stdin(Stdio::piped()).stdout(Stdio::piped()).spawn().unwrap());
        let mut messages = BufReader::new(child.stdout.take().unwrap());
        let (sender, from) = mpsc::channel();
        thread::spawn(move || {
            let mut message = Vec::new();
            while messages.read_until(0, &mut message).is_ok_and(|read| read > 0) {
                message.pop();
                let _ = sender.send(serde_json::from_slice(&message).unwrap());
                message.clear();
            }
        });
        let to = child.stdin.take().unwrap();
        let mut browser = Self {
            _child: child,
            to,
            from,
            session: Value::Null,
            number: 0,
            asked: Vec::new(),
            _profile: profile,
        };
        let pages = browser.call("Target.getTargets", json!({}));
        let page =
            pages["targetInfos"].as_array().unwrap().iter().find(|target| target["type"] == "page").unwrap();
        let attach = json!({ "targetId": page["targetId"], "flatten": true });
        browser.session = browser.call("Target.attachToTarget", attach)["sessionId"].clone();
        browser.call("Network.enable", json!({}));
        browser.call("Page.enable", json!({}));
        let watch = "addEventListener('securitypolicyviolation', e => (window.violations ??= []).push(e.violatedDirective))";
        browser.call("Page.addScriptToEvaluateOnNewDocument", json!({ "source": watch }));
        browser.go(address);
        browser
    }

    pub(super) fn go(&mut self, address: &str) {
        self.call("Page.navigate", json!({ "url": address }));
    }

    /// Sends a request to the browser; returns the number of the answer.
    fn put(&mut self, method: &str, parameters: &Value) -> u64 {
        self.number += 1;
        let mut message = json!({ "id": self.number, "method": method, "params": parameters });
        if !self.session.is_null() {
            message["sessionId"] = self.session.clone();
        }
        self.to.write_all(message.to_string().as_bytes()).unwrap();
        self.to.write_all(&[0]).unwrap();
        self.number
    }

    /// Waits for the answer of this number, which must be no error.
    fn answer(&mut self, number: u64) -> Value {
        let answer = self.heard(number);
        assert!(answer["error"].is_null(), "{answer}");
        answer["result"].clone()
    }

    /// Waits for the answer of this number, which may be an error.
    fn heard(&mut self, number: u64) -> Value {
        loop {
            let message =
                self.from.recv_timeout(HANG).unwrap_or_else(|_| panic!("the browser does not answer"));
            if message["method"] == "Network.requestWillBeSent" {
                self.asked.push(message["params"]["request"]["url"].as_str().unwrap().to_owned());
            }
            if message["id"] == number {
                return message;
            }
        }
    }

    pub(super) fn call(&mut self, method: &str, parameters: impl Into<Value>) -> Value {
        let number = self.put(method, &parameters.into());
        self.answer(number)
    }

    /// The value of a script in the page.
    pub(super) fn evaluate(&mut self, script: &str) -> Value {
        self.evaluated(script).unwrap_or_else(|left| panic!("{script}: {left}"))
    }

    /// Like [`Self::evaluate`]; an error if the page is left for another one meanwhile.
    fn evaluated(&mut self, script: &str) -> Result<Value, Value> {
        let parameters = json!({ "expression": script, "awaitPromise": true, "returnByValue": true });
        let number = self.put("Runtime.evaluate", &parameters);
        let answer = self.heard(number);
        if answer["error"]["message"] == "Inspected target navigated or closed" {
            return Err(answer);
        }
        assert!(answer["error"].is_null(), "{script}: {answer}");
        let said = &answer["result"];
        assert!(said["exceptionDetails"].is_null(), "{script}: {said}");
        Ok(said["result"]["value"].clone())
    }

    /// Waits until a script in the page returns true.
    pub(super) fn wait(&mut self, script: &str) {
        let start = Instant::now();
        // While one page is left for another, there is no value yet.
        while self.evaluated(script) != Ok(json!(true)) {
            if start.elapsed() > HANG {
                let page = self.evaluate("document.body.innerText");
                panic!("{script} did not come true; the page says {page}");
            }
            thread::sleep(LOOK);
        }
    }

    /// Presses the keys of `text` and then `end`, this long apart, as a scanner does.
    pub(super) fn scan(&mut self, text: &str, end: &str, apart: Duration) {
        let keys: Vec<String> = text.chars().map(String::from).collect();
        let mut last = 0;
        for key in keys.iter().map(String::as_str).chain([end]) {
            let typed = match key {
                "Enter" => "\r",
                "Tab" | "Escape" => "",
                key => key,
            };
            self.put("Input.dispatchKeyEvent", &json!({ "type": "keyDown", "key": key, "text": typed }));
            last = self.put("Input.dispatchKeyEvent", &json!({ "type": "keyUp", "key": key }));
            if !apart.is_zero() {
                thread::sleep(apart);
            }
        }
        self.answer(last);
    }
}
