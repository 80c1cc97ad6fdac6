//! `halfrow-station serve`

use std::io;
use std::sync::Arc;
use std::time::{Duration, Instant};

use clap::Args;
use halfrow::verdict::StoppedBy;

use super::Failure;
use super::beginning::{Disk, Ready, Sending, SettingsFile, Signal};
use super::fetching::fetch_at_start;
use super::notify::Notify;
use crate::console;
use crate::engine::{Engine, EngineEnded};
use crate::exit::Exit;
use crate::settings::Settings;
use crate::store::LastTold;
use crate::web::{Access, App, Server, User, Who};

/// How often systemd is told that the engine works.
const TELL: Duration = Duration::from_secs(1);

/// Judge the boards in all lanes of a station, with pages in a browser
///
/// Prints where the pages are. systemd is told when it is ready, and every second that it works. A signal ends the runs that are under way, and the program.
#[derive(Debug, Args)]
pub(super) struct Arguments {
    #[command(flatten)]
    settings: SettingsFile,
    /// Who tests, at a station where nobody logs in
    #[arg(long, value_name = "NAME", env = "USER", default_value = "unknown")]
    operator: String,
    #[command(flatten)]
    disk: Disk,
}

pub(super) fn run(arguments: &Arguments) -> Result<Exit, Failure> {
    fetch_at_start(&arguments.settings)?;
    let settings = arguments.settings.load()?;
    let everybody = User { name: arguments.operator.clone(), who: Who::Operator };
    let served = Served { settings: &settings, disk: &arguments.disk, everybody, hints: Vec::new() };
    serve(served, |_| Ok(()))
}

/// What is served.
pub(super) struct Served<'a> {
    pub(super) settings: &'a Settings,
    /// Which disks are taken for its folder.
    pub(super) disk: &'a Disk,
    /// Who anybody at the computer itself is, where nobody logs in.
    pub(super) everybody: User,
    /// Serial numbers that a visitor of a demonstration may type.
    pub(super) hints: Vec<String>,
}

/// Serves the station until a signal comes; `begin` is called once it is at work.
pub(super) fn serve(
    served: Served<'_>,
    begin: impl FnOnce(&Arc<Engine>) -> io::Result<()>,
) -> Result<Exit, Failure> {
    let notify = Notify::of_environment();
    let ready = notify.while_opening(|| Ready::of(served.settings, served.disk))?;
    until_signal(ready, served, &notify, begin)
}

/// The same once the store is open.
fn until_signal(
    ready: Ready<'_>,
    served: Served<'_>,
    notify: &Notify,
    begin: impl FnOnce(&Arc<Engine>) -> io::Result<()>,
) -> Result<Exit, Failure> {
    let Served { settings, everybody, hints, .. } = served;
    let signal = ready.signal.clone();
    let access = Access::of(settings, everybody)?;
    let listener = Server::listen(access.listen()).map_err(Failure::call)?;
    let at = listener.local_addr().map_err(Failure::error)?;
    let engine = Arc::new(ready.start()?);
    let sending = Sending::begin(settings, engine.store(), &LastTold::default())?;
    let app = App::new(settings.clone(), Arc::clone(&engine), access.at(at.port()), hints);
    let server = Server::start(&app.map_err(Failure::error)?, listener).map_err(Failure::error)?;
    begin(&engine).map_err(Failure::error)?;
    console::tell(&format!("The pages are at http://{at}/"));
    notify.ready();
    let ended = at_work(&signal, &engine, (&server, &sending), notify);
    engine.close(Some(*ended.as_ref().unwrap_or(&StoppedBy::Caller)));
    server.close();
    Ok(halfrow::Cause::Stopped(ended?).into())
}

/// Waits until a signal comes, and tells systemd meanwhile that the engine works. A part that has ended unasked ends the wait: only
/// another start brings it back.
fn at_work(
    signal: &Signal,
    engine: &Engine,
    (server, sending): (&Server, &Sending),
    notify: &Notify,
) -> Result<StoppedBy, Failure> {
    let mut told = Instant::now();
    signal.wait(|| {
        if engine.has_ended() {
            return Err(Failure::error(EngineEnded));
        }
        server.refuse_ended().map_err(Failure::error)?;
        sending.refuse_ended()?;
        if told.elapsed() >= TELL {
            told = Instant::now();
            tell(engine, notify);
        }
        Ok(())
    })
}

/// Tells systemd that the engine works, if it does.
fn tell(engine: &Engine, notify: &Notify) {
    if engine.is_well() {
        notify.works();
    }
}

#[cfg(test)]
mod tests {
    use std::fs;
    use std::sync::mpsc;
    use std::thread;

    use super::*;
    use crate::engine::tests::{station, stopped};
    use crate::outbox::{Faulty, SendingEnded};
    use crate::store::{Folder, Store};

    #[test]
    fn systemd_is_not_told_that_an_engine_works_that_does_not() {
        let folder = tempfile::tempdir().unwrap();
        let (_, engine) = stopped(folder.path());
        let (systemd, notify) = Notify::heard_in(folder.path());
        systemd.set_nonblocking(true).unwrap();
        for (seconds, is_told) in [(6, false), (0, true)] {
            engine.silent_for(Duration::from_secs(seconds));
            tell(&engine, &notify);
            let mut heard = [0; 64];
            assert_eq!(systemd.recv(&mut heard).ok(), is_told.then_some("WATCHDOG=1".len()));
        }
    }

    /// systemd starts it again, and what was kept is sent.
    #[test]
    fn a_station_that_sends_nothing_any_more_ends() {
        let folder = tempfile::tempdir().unwrap();
        let (settings, engine) = station(folder.path());
        let everybody = User { name: "weber".to_owned(), who: Who::Operator };
        let access = Access::of(&settings, everybody).unwrap();
        let app = App::new(settings, Arc::clone(&engine), access, Vec::new()).unwrap();
        let server = Server::start(&app, Server::listen("127.0.0.1:0".parse().unwrap()).unwrap()).unwrap();
        let sending = Sending::to(vec![Box::new(Faulty)], engine.store()).unwrap();
        let (told, ended) = mpsc::channel();
        let worked = Arc::clone(&engine);
        thread::spawn(move || {
            let parts = (&server, &sending);
            told.send(at_work(&Signal::default(), &worked, parts, &Notify::default()).unwrap_err()).unwrap();
            server.close();
        });
        let failure = ended.recv_timeout(Duration::from_secs(60)).unwrap();
        assert!(failure.exit == Exit::Error && failure.error.is::<SendingEnded>(), "{failure:?}");
        engine.close(None);
    }

    /// Without systemd's watchdog, the program's end is all that can be noticed from outside.
    #[test]
    fn a_station_whose_engine_has_ended_ends_with_its_log_in_the_database() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("station.toml");
        let lane = "[[lane]]\nname = \"1\"\nboard = \"mock\"\nplans = [\"plan.toml\"]\n";
        let web = "[web]\nlisten = \"127.0.0.1:0\"\n";
        fs::write(&path, format!("schema = 1\n[station]\nname = \"12\"\ndata = \"data\"\n{web}{lane}"))
            .unwrap();
        fs::write(folder.path().join("plan.toml"), include_str!("../../tests/station/quick.toml")).unwrap();
        let settings = Settings::load(&path).unwrap();
        let (told, ended) = mpsc::channel();
        thread::spawn(move || {
            let (disk, everybody) = (Disk::default(), User { name: String::new(), who: Who::Operator });
            let store = Store::open(&Folder::new(&settings.data)).unwrap();
            let ready = Ready { settings: &settings, store, signal: Signal::default() };
            let served = Served { settings: &settings, disk: &disk, everybody, hints: Vec::new() };
            // A store that others still have is not closed, which would fold its log, too.
            let mut kept = None;
            let begin = |engine: &Arc<Engine>| {
                kept = Some(engine.store());
                engine.close(None);
                Ok(())
            };
            let failure = until_signal(ready, served, &Notify::default(), begin).unwrap_err();
            let log = fs::metadata(settings.data.join("station.db-wal")).unwrap().len();
            told.send((failure.error.is::<EngineEnded>(), log)).unwrap();
            drop(kept);
        });
        assert_eq!(ended.recv_timeout(Duration::from_secs(60)), Ok((true, 0)));
    }
}
