//! A station's own network, with a cable to this computer that can be unplugged: a namespace of Linux, which needs root.

use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::OnceLock;

use tempfile::TempDir;

use super::{Trial, lock};
use crate::common::plant_settings;
use crate::plant::link::certificates_for;
use crate::plant::server::Server;

/// The authority that signs the server's certificate.
static AUTHORITY: OnceLock<TempDir> = OnceLock::new();

/// Makes the server speak TLS in all these networks.
pub(super) fn opened(server: &mut Server) {
    let folder = AUTHORITY.get_or_init(|| tempfile::tempdir().unwrap());
    let names: Vec<_> = (0..16).map(|number| format!("IP:{}", near(number))).collect();
    certificates_for(folder.path(), &names.join(","));
    server.speaks_tls(folder.path());
    server.listens_everywhere();
}

/// The address of this computer's end of the cable.
fn near(number: u32) -> String {
    format!("10.213.{number}.1")
}

/// A network of a station's own.
pub(super) struct Network {
    number: u32,
    name: String,
}

impl Network {
    pub(super) fn new(number: u32) -> Self {
        let name = format!("hr{}-{number}", std::process::id() % 10_000);
        let far = format!("10.213.{number}.2/24");
        ip(&format!("netns add {name}"));
        ip(&format!("link add {name} type veth peer name {name}p netns {name}"));
        ip(&format!("addr add {}/24 dev {name}", near(number)));
        ip(&format!("link set {name} up"));
        ip(&format!("-n {name} addr add {far} dev {name}p"));
        ip(&format!("-n {name} link set {name}p up"));
        ip(&format!("-n {name} link set lo up"));
        Self { number, name }
    }

    /// The part of the settings about the plant.
    pub(super) fn settings(&self, trial: &Trial, folder: &Path) -> String {
        let port = lock(&trial.server).port();
        let ca: PathBuf = folder.join("ca.pem");
        std::fs::copy(AUTHORITY.get().unwrap().path().join("ca.pem"), &ca).unwrap();
        format!(
            "{}ca = \"{}\"\n",
            plant_settings(&format!("postgres://postgres@{}:{port}/plant", near(self.number))),
            ca.display()
        )
    }

    /// A command that runs this program in this network.
    pub(super) fn command(&self, program: &Path) -> Command {
        let mut command = Command::new("ip");
        command.args(["netns", "exec", &self.name]).arg(program);
        command
    }

    /// Plugs the cable in, or unplugs it.
    pub(super) fn plug(&self, is_plugged: bool) {
        ip(&format!("link set {} {}", self.name, if is_plugged { "up" } else { "down" }));
    }
}

impl Drop for Network {
    fn drop(&mut self) {
        let _ = Command::new("ip").args(["link", "del", &self.name]).status();
        let _ = Command::new("ip").args(["netns", "del", &self.name]).status();
    }
}

fn ip(arguments: &str) {
    let did = Command::new("ip").args(arguments.split(' ')).output();
    let did = did.unwrap_or_else(|error| panic!("ip is missing ({error}); apt-get install iproute2"));
    assert!(
        did.status.success(),
        "ip {arguments}: {}; this needs root",
        String::from_utf8_lossy(&did.stderr)
    );
}
