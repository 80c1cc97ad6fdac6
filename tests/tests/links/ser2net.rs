//! ser2net on this computer, with a board behind a pseudo-terminal.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};

use halfrow_tests::patience::wait_until;
use halfrow_tests::program::Folder;
use halfrow_tests::served::{Replug, Served};

use crate::{ends, passes, verify};

/// A running ser2net, which is killed when dropped.
struct Ser2net {
    child: Child,
    port: u16,
}

impl Ser2net {
    /// Starts one that exports `device`.
    fn start(folder: &Folder, device: &Path) -> Self {
        let device = device.display();
        let configuration = format!(
            "connection: &board\n  accepter: tcp,127.0.0.1,0\n  connector: serialdev,{device},3000000n81,local\n  \
             options:\n    kickolduser: false\n    chardelay: false\n"
        );
        folder.write("ser2net.yaml", configuration);
        let mut command = Command::new(program());
        command.args(["-n", "-d", "-c"]).arg(folder.path().join("ser2net.yaml"));
        let child = command.stdout(Stdio::null()).stderr(Stdio::null()).spawn().unwrap();
        let mut started = Self { child, port: 0 };
        wait_until("ser2net to listen", || {
            started.port = started.listens_on().unwrap_or_default();
            started.port > 0
        });
        started
    }

    fn target(&self) -> String {
        format!("tcp:127.0.0.1:{}", self.port)
    }

    /// The targets of its descriptors.
    fn open_files(&self) -> Vec<PathBuf> {
        let descriptors =
            fs::read_dir(format!("/proc/{}/fd", self.child.id())).into_iter().flatten().flatten();
        descriptors.filter_map(|descriptor| fs::read_link(descriptor.path()).ok()).collect()
    }

    /// The port that the system has given it. It is looked up among the listening ports, since a connection would open the
    /// device.
    fn listens_on(&self) -> Option<u16> {
        let ours = self.open_files();
        fs::read_to_string("/proc/net/tcp").unwrap().lines().find_map(|line| {
            // Number, near end, far end, state (0A: listening), and five more fields before the inode.
            let fields: Vec<_> = line.split_whitespace().collect();
            let [_, near, _, "0A", _, _, _, _, _, inode, ..] = fields[..] else { return None };
            let is_ours = ours.contains(&format!("socket:[{inode}]").into());
            u16::from_str_radix(near.rsplit_once(':')?.1, 16).ok().filter(|_| is_ours)
        })
    }
}

impl Drop for Ser2net {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

/// Debian puts it into a folder that is not on a user's path.
fn program() -> PathBuf {
    let folders =
        ["/usr/sbin", "/usr/local/sbin", "/usr/bin"].map(|folder| Path::new(folder).join("ser2net"));
    let found = folders.into_iter().find(|program| program.is_file());
    assert!(found.is_some(), "ser2net is missing; run: apt-get install ser2net");
    found.unwrap()
}

#[test]
fn a_board_behind_ser2net_passes_again_and_again() {
    let folder = Folder::new();
    let served = Served::on_a_serial_port("mock");
    let ser2net = Ser2net::start(&folder, Path::new(served.address()));
    for _ in 0..2 {
        let ended = verify(&ser2net.target(), &[]).succeeded();
        assert_eq!(ended.json()["board"]["kind"], "mock");
    }
}

#[test]
fn a_second_host_is_busy_and_a_board_that_is_not_there_is_named() {
    let folder = Folder::new();
    let served = Served::on_a_serial_port("mock");
    let ser2net = Ser2net::start(&folder, Path::new(served.address()));
    let first = std::net::TcpStream::connect(("127.0.0.1", ser2net.port)).unwrap();
    let device = fs::canonicalize(served.address()).unwrap();
    wait_until("ser2net to open the device", || ser2net.open_files().contains(&device));
    ends(&verify(&ser2net.target(), &[]), 4, "another host is connected");
    drop(first);
    drop(ser2net);
    let none = Ser2net::start(&folder, Path::new("/dev/halfrow-is-not-there"));
    ends(&verify(&none.target(), &[]), 3, "`Device open failure: Value or file not found` and no board");
    passes(&served);
}

#[test]
fn a_board_unplugged_behind_ser2net_is_an_error() {
    let folder = Folder::new();
    let served = Served::on_a_serial_port("mock,fault=disconnect,packet=60");
    let ser2net = Ser2net::start(&folder, Path::new(served.address()));
    ends(&verify(&ser2net.target(), &[]), 3, "was closed at");
}

#[test]
fn a_run_goes_on_when_the_board_behind_ser2net_comes_back() {
    let folder = Folder::new();
    let path = folder.path().join("board");
    let served = Served::unplugged_once("mock", &path, 5000, Some(Replug::Powered));
    let ser2net = Ser2net::start(&folder, Path::new(served.address()));
    let ended = verify(&ser2net.target(), &["--reconnect=300"]).succeeded();
    assert_eq!(ended.json()["link"]["reconnections"].as_array().unwrap().len(), 1);
}
