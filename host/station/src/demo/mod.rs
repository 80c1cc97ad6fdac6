//! A station for show: mock boards with drawn faults, and a line that works by itself.

mod board;

use std::fs;
use std::io;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Weak};
use std::thread;
use std::time::{Duration, Instant};

use crate::engine::Engine;
use crate::floor::Word;
use crate::plan::serial::SerialRule;
use crate::settings::Settings;
use board::{Fixture, drawn};

/// The most lanes.
pub(crate) const MOST_LANES: usize = 16;
/// The name under which the line scans.
const OPERATOR: &str = "demonstration";
/// How often the line checks its lanes.
const LOOK: Duration = Duration::from_millis(250);
/// How long a verdict stays at least, and the unit of the time that is drawn beyond it.
const REST: Duration = Duration::from_secs(3);
const DRAWN_REST: Duration = Duration::from_millis(25);
/// How many serial numbers a visitor is shown.
const SHOWN: usize = 3;

const PLAN: &str = include_str!("../../assets/demo-plan.toml");

/// The station of the demonstration.
#[derive(Debug)]
pub(crate) struct Demo {
    /// Its settings, in the folder that it was made in.
    pub settings: PathBuf,
    fixtures: Vec<Fixture>,
}

impl Demo {
    /// A station with `lanes` lanes, 1 to [`MOST_LANES`], whose files are created in `folder`, which must be new or empty, and
    /// whose pages listen on `port`.
    ///
    /// # Errors
    /// When the folder has something already, or the system has no room.
    pub(crate) fn new(folder: &Path, lanes: usize, port: u16) -> io::Result<Self> {
        let fixtures: Vec<_> = (0..lanes).map(|_| Fixture::start()).collect::<io::Result<_>>()?;
        let lane = |(fixture, name): (&Fixture, usize)| {
            format!(
                "[[lane]]\nname = \"{name}\"\nboard = \"tcp:{}\"\nplans = [\"plan.toml\"]\n",
                fixture.address
            )
        };
        let lanes: String = fixtures.iter().zip(1..).map(lane).collect();
        let text = format!(
            "schema = 1\n[station]\nname = \"demo\"\ndata = \"data\"\n[web]\nlisten = \"127.0.0.1:{port}\"\n{lanes}"
        );
        fs::create_dir_all(folder)?;
        // A station's folder among it would get results of boards that do not exist.
        if fs::read_dir(folder)?.next().is_some() {
            return Err(io::ErrorKind::DirectoryNotEmpty.into());
        }
        let settings = folder.join("station.toml");
        for (path, text) in [(&settings, text.as_str()), (&folder.join("plan.toml"), PLAN)] {
            io::Write::write_all(&mut fs::File::create_new(path)?, text.as_bytes())?;
        }
        Ok(Self { settings, fixtures })
    }

    /// Starts the line. The last of several lanes is the visitor's.
    ///
    /// # Errors
    /// When the system has no thread for it.
    pub(crate) fn start(self, engine: &Arc<Engine>, settings: &Settings) -> io::Result<()> {
        let Some(rule) = settings.plans.first().map(|file| file.plan.serial.clone()) else { return Ok(()) };
        let engine = Arc::downgrade(engine);
        thread::Builder::new().name("line".to_owned()).spawn(move || line(&engine, &self.fixtures, &rule))?;
        Ok(())
    }
}

/// Serial numbers that a visitor may type.
#[must_use]
pub fn serials(settings: &Settings) -> Vec<String> {
    let rule = settings.plans.first().map(|file| &file.plan.serial);
    rule.map(|rule| (0..SHOWN).filter_map(|_| serial(rule)).collect()).unwrap_or_default()
}

/// A drawn serial number with its check digit.
fn serial(rule: &SerialRule) -> Option<String> {
    let digits: String = drawn::<9>().map(|byte| char::from(b'0' + byte % 10)).iter().collect();
    let mut all = "0123456789X".chars().map(|check| format!("CA{digits}{check}"));
    all.find(|serial| rule.read(serial).is_ok())
}

fn line(engine: &Weak<Engine>, fixtures: &[Fixture], rule: &SerialRule) {
    let by_itself = if fixtures.len() > 1 { fixtures.len() - 1 } else { 1 };
    let mut since = vec![(Word::Empty, Instant::now(), REST); fixtures.len()];
    while let Some(engine) = engine.upgrade() {
        for (lane, ((state, fixture), known)) in
            engine.lanes().iter().zip(fixtures).zip(&mut since).enumerate()
        {
            if known.0 != state.state {
                *known = (state.state, Instant::now(), REST + DRAWN_REST * u32::from(drawn::<1>()[0]));
                if state.state.is_verdict() {
                    fixture.exchange();
                }
            }
            let is_due =
                (state.state.is_verdict() || state.state == Word::Ready) && known.1.elapsed() > known.2;
            if let Some(serial) = serial(rule).filter(|_| is_due && lane < by_itself) {
                engine.label(0, Some(lane), &serial, OPERATOR, None);
            }
        }
        drop(engine);
        thread::sleep(LOOK);
    }
}
