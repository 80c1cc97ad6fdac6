//! A PostgreSQL server in its own folder, which ends with its test.

use std::fs::{self, File};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::sync::OnceLock;
use std::thread;
use std::time::{Duration, Instant};

use halfrow_station::store::{Plant, PlantAddress};
use postgres::{Client, NoTls};
use tempfile::TempDir;

use crate::common::{PORTS_TRIED, free_port, until};

/// How long a server may take to start.
const STARTED: Duration = Duration::from_secs(60);

/// A PostgreSQL server.
pub(crate) struct Server {
    folder: TempDir,
    port: u16,
    /// The addresses that it listens on.
    listen: &'static str,
    process: Option<Child>,
}

impl Server {
    /// A running server, with an empty database `plant`.
    pub(crate) fn start() -> Self {
        let folder = tempfile::tempdir().unwrap();
        give_to_server(folder.path());
        let mut server = Self { folder, port: free_port(), listen: "127.0.0.1", process: None };
        copy(cluster(), &server.data());
        for left in (0..PORTS_TRIED).rev() {
            if server.begins() {
                break;
            }
            assert!(left > 0, "the server does not start: {}", server.said());
            server.kill();
            server.port = free_port();
        }
        server.client("postgres").batch_execute("CREATE DATABASE plant").unwrap();
        server
    }

    /// A running server with the plant's tables.
    pub(crate) fn prepared() -> Self {
        let server = Self::start();
        Plant::prepare(&server.address()).unwrap();
        server
    }

    /// From now on the plant can never hold a new row of `table`, as if it had a character that the encoding lacks (PostgreSQL,
    /// appendix A).
    pub(crate) fn never_holds(&self, table: &str) {
        let never = format!(
            "CREATE FUNCTION never() RETURNS trigger LANGUAGE plpgsql AS
                $$ BEGIN RAISE EXCEPTION 'no such character' USING ERRCODE = '22021'; END $$;
            CREATE TRIGGER never BEFORE INSERT ON {table} FOR EACH ROW EXECUTE FUNCTION never()"
        );
        self.change(&never);
    }

    /// From now on the plant loses every new row of `table`, and says that it has entered it.
    pub(crate) fn loses(&self, table: &str) {
        let loses = format!(
            "CREATE FUNCTION lost() RETURNS trigger LANGUAGE plpgsql AS $$ BEGIN RETURN NULL; END $$;
            CREATE TRIGGER lost BEFORE INSERT ON {table} FOR EACH ROW EXECUTE FUNCTION lost()"
        );
        self.change(&loses);
    }

    /// Ends [`Self::loses`].
    pub(crate) fn loses_nothing(&self, table: &str) {
        let ends = format!("DROP TRIGGER lost ON {table}; DROP FUNCTION lost");
        self.change(&ends);
    }

    pub(crate) fn data(&self) -> PathBuf {
        self.folder.path().join("data")
    }

    pub(crate) fn port(&self) -> u16 {
        self.port
    }

    /// Starts it again.
    pub(crate) fn again(&mut self) {
        assert!(self.begins(), "the server does not start again at port {}: {}", self.port, self.said());
    }

    /// Starts it. Returns false if its port is taken by now, or if it does not start, which [`Server::said`] explains.
    fn begins(&mut self) -> bool {
        let mut server = as_server("postgres");
        server.arg("-D").arg(self.data()).args(["-p", &self.port.to_string(), "-k"]).arg(self.folder.path());
        server.args([
            "-c",
            &format!("listen_addresses={}", self.listen),
            "-c",
            "fsync=off",
            // Goes with the folder, however the server ends.
            "-c",
            "dynamic_shared_memory_type=mmap",
            "-c",
            "max_connections=400",
        ]);
        let log = File::create(self.log()).unwrap();
        let mut process = server.stdout(Stdio::null()).stderr(log).spawn().unwrap();
        let until = Instant::now() + STARTED;
        let is_ours = loop {
            match self.connected("postgres") {
                Ok(mut client) => break self.is_of(&mut client),
                Err(_) if process.try_wait().unwrap().is_some() => break false,
                Err(error) => assert!(Instant::now() < until, "{error}"),
            }
            thread::sleep(Duration::from_millis(20));
        };
        self.process = Some(process);
        is_ours
    }

    fn log(&self) -> PathBuf {
        self.folder.path().join("server.log")
    }

    /// What it has logged since it was started.
    fn said(&self) -> String {
        fs::read_to_string(self.log()).unwrap()
    }

    fn is_of(&self, client: &mut Client) -> bool {
        let folder: String = client.query_one("SHOW data_directory", &[]).unwrap().get(0);
        self.data() == Path::new(&folder)
    }

    /// Gives it a certificate and its key from `folder`, and restarts it.
    pub(crate) fn speaks_tls(&mut self, folder: &Path) {
        for name in ["server.crt", "server.key"] {
            fs::copy(folder.join(name), self.data().join(name)).unwrap();
        }
        self.owned("server.key", "0600");
        self.configured("ssl = on\n");
        self.kill();
        self.again();
    }

    /// Restarts it such that everybody can reach it, also from other computers.
    pub(crate) fn listens_everywhere(&mut self) {
        self.listen = "*";
        self.allowed("host all all all trust\n");
        self.kill();
        self.again();
    }

    /// Makes it ask this user for a password.
    pub(crate) fn asks_for_a_password(&self, user: &str) {
        self.allowed(&format!("host all {user} all scram-sha-256\n"));
        self.client("postgres").batch_execute("SELECT pg_reload_conf()").unwrap();
    }

    /// Puts a rule before all others.
    fn allowed(&self, rule: &str) {
        let path = self.data().join("pg_hba.conf");
        let rules = fs::read_to_string(&path).unwrap();
        fs::write(&path, rule.to_owned() + &rules).unwrap();
    }

    fn configured(&self, line: &str) {
        let path = self.data().join("postgresql.conf");
        let lines = fs::read_to_string(&path).unwrap();
        fs::write(&path, lines + line).unwrap();
    }

    fn owned(&self, name: &str, mode: &str) {
        let path = self.data().join(name);
        give_to_server(&path);
        assert!(Command::new("chmod").arg(mode).arg(&path).status().unwrap().success());
    }

    /// Kills the server with SIGKILL; its child processes then end by themselves.
    pub(crate) fn kill(&mut self) {
        let Some(mut process) = self.process.take() else { return };
        let (memory, children) = (self.memory(), self.children());
        process.kill().unwrap();
        process.wait().unwrap();
        // The server does not start while a child still holds its memory.
        until("the end of the server's processes", || !children.iter().any(|child| is_running(child)));
        // A machine has few of these segments, and they outlive the process that made them.
        if let Some(memory) = memory {
            let _ = Command::new("ipcrm").args(["-m", &memory]).status();
        }
        let socket = self.folder.path().join(format!(".s.PGSQL.{}.lock", self.port));
        for left in [socket, self.data().join("postmaster.pid")] {
            let _ = fs::remove_file(left);
        }
    }

    /// The ids of the processes that it has started.
    fn children(&self) -> Vec<String> {
        let lock = fs::read_to_string(self.data().join("postmaster.pid")).unwrap_or_default();
        let id = lock.lines().next().unwrap_or_default();
        let children = fs::read_to_string(format!("/proc/{id}/task/{id}/children")).unwrap_or_default();
        children.split_whitespace().map(str::to_owned).collect()
    }

    /// The id of its segment of shared memory (System V), by which a server checks whether another one has its folder.
    fn memory(&self) -> Option<String> {
        let lock = fs::read_to_string(self.data().join("postmaster.pid")).ok()?;
        let key_and_number = lock.lines().nth(6)?;
        key_and_number.split_whitespace().nth(1).map(str::to_owned)
    }

    pub(crate) fn url(&self) -> String {
        format!("postgres://postgres@127.0.0.1:{}/plant", self.port)
    }

    pub(crate) fn address(&self) -> PlantAddress {
        PlantAddress::new(&self.url(), None, None).unwrap()
    }

    pub(crate) fn client(&self, database: &str) -> Client {
        self.connected(database).unwrap()
    }

    fn connected(&self, database: &str) -> Result<Client, postgres::Error> {
        let text = format!("host=127.0.0.1 port={} user=postgres dbname={database}", self.port);
        Client::connect(&text, NoTls)
    }

    /// Changes the plant without the program.
    pub(crate) fn change(&self, text: &str) {
        self.client("plant").batch_execute(text).unwrap();
    }

    /// All rows that `text` selects, each value as text.
    pub(crate) fn rows(&self, text: &str) -> Vec<Vec<String>> {
        rows(&mut self.client("plant"), text)
    }
}

/// Whether a process runs; one that has ended and was not waited for has no command line.
fn is_running(id: &str) -> bool {
    fs::read(format!("/proc/{id}/cmdline")).is_ok_and(|line| !line.is_empty())
}

impl Drop for Server {
    fn drop(&mut self) {
        self.kill();
    }
}

/// All rows that `text` selects, each value as text, as the server itself converts it.
pub(crate) fn rows(client: &mut Client, text: &str) -> Vec<Vec<String>> {
    let rows = client.simple_query(text).unwrap();
    let row = |message| match message {
        postgres::SimpleQueryMessage::Row(row) => {
            Some((0..row.len()).map(|at| row.get(at).unwrap_or("NULL").to_owned()).collect())
        }
        _ => None,
    };
    rows.into_iter().filter_map(row).collect()
}

/// The user that Debian's package makes for the server, which refuses to run as root.
const USER: &str = "postgres";

/// A cluster that has never run. Every server starts with a copy, since making a cluster takes longer than most of the tests.
fn cluster() -> &'static Path {
    static MADE: OnceLock<PathBuf> = OnceLock::new();
    MADE.get_or_init(|| {
        let version = Command::new(program_path("postgres")).arg("--version").output().unwrap();
        let version =
            String::from_utf8(version.stdout).unwrap().replace(|c: char| !c.is_ascii_alphanumeric(), "_");
        let cluster = Path::new(env!("CARGO_TARGET_TMPDIR")).join(version);
        if !cluster.exists() {
            let made = made_cluster();
            let aside = tempfile::tempdir_in(env!("CARGO_TARGET_TMPDIR")).unwrap();
            let whole = aside.path().join("data");
            copy(made.path(), &whole);
            // Another process may have been faster.
            let renamed = fs::rename(whole, &cluster);
            assert!(renamed.is_ok() || cluster.exists(), "{renamed:?}");
        }
        cluster
    })
}

/// Makes a cluster in a folder that the server's user can reach.
fn made_cluster() -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    give_to_server(folder.path());
    let made = as_server("initdb")
        .arg("--pgdata")
        .arg(folder.path())
        .args(["--auth=trust", "--username=postgres", "--encoding=UTF8", "--locale=C", "--no-sync"])
        // In megabytes: each copy of a cluster contains one segment.
        .arg("--wal-segsize=1")
        .output()
        .unwrap();
    assert!(made.status.success(), "{}", String::from_utf8_lossy(&made.stderr));
    folder
}

/// Copies with owners, since a server refuses a cluster of another user.
fn copy(cluster: &Path, to: &Path) {
    let copied = Command::new("cp").arg("--archive").arg(cluster).arg(to).status().unwrap();
    assert!(copied.success(), "{} cannot be copied", cluster.display());
}

fn give_to_server(path: &Path) {
    if is_root() {
        let given = Command::new("chown").arg(USER).arg(path).status().unwrap();
        assert!(given.success(), "there is no user {USER}");
    }
}

fn is_root() -> bool {
    Command::new("id").arg("-u").output().unwrap().stdout == b"0\n"
}

/// One of PostgreSQL's programs, which ends with this thread.
fn as_server(program: &str) -> Command {
    let mut command = Command::new("setpriv");
    // SIGQUIT also ends a server at once, but lets it release its shared memory.
    command.args(["--pdeathsig", "QUIT"]);
    if is_root() {
        command.args(["--reuid", USER, "--regid", USER, "--clear-groups"]);
    }
    command.arg(program_path(program));
    command
}

/// Where Debian keeps the newest server's programs; on other systems they are on the path.
fn program_path(program: &str) -> PathBuf {
    let versions = fs::read_dir("/usr/lib/postgresql").into_iter().flatten().flatten();
    let number = |path: &Path| path.file_name()?.to_str()?.parse::<u32>().ok();
    let found = versions.map(|entry| entry.path()).filter_map(|path| Some((number(&path)?, path))).max();
    found.map_or_else(|| PathBuf::from(program), |(_, path)| path.join("bin").join(program))
}
