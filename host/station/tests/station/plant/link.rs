//! The link to the plant: TLS wherever it leaves the computer, and a password that is never shown.

use std::fs;
use std::os::unix::fs::PermissionsExt as _;
use std::path::Path;
use std::process::Command;

use halfrow_station::store::{Plant, PlantAddress, PlantAddressError};
use halfrow_station::trust::TrustError;
use tempfile::TempDir;

use super::server::Server;
use crate::common::{LANE, program, query};

/// A password that occurs nowhere else.
const PASSWORD: &str = "correct-horse-battery-5e1f";
/// A wrong password.
const WRONG: &str = "wrong-horse-5e1f";

/// Makes an authority, and a certificate for `localhost` signed by it, in `folder`: ca.pem, server.crt, server.key.
pub(crate) fn certificates(folder: &Path) {
    certificates_for(folder, "IP:127.0.0.1");
}

/// Like [`certificates`], for these names as well.
pub(crate) fn certificates_for(folder: &Path, names: &str) {
    let script = "set -e
        openssl req -x509 -newkey rsa:2048 -nodes -keyout ca.key -out ca.pem -days 2 -subj /CN=authority 2>/dev/null
        openssl req -newkey rsa:2048 -nodes -keyout server.key -out server.csr -subj /CN=localhost 2>/dev/null
        printf 'subjectAltName=DNS:localhost,%s' \"$NAMES\" >names
        openssl x509 -req -in server.csr -CA ca.pem -CAkey ca.key -CAcreateserial -days 2 -extfile names -out server.crt 2>/dev/null";
    assert!(
        Command::new("sh")
            .args(["-c", script])
            .env("NAMES", names)
            .current_dir(folder)
            .status()
            .unwrap()
            .success()
    );
}

#[test]
fn what_leaves_the_computer_goes_through_tls_and_to_the_plant_alone() {
    let mut server = Server::start();
    let place = tempfile::tempdir().unwrap();
    certificates(place.path());
    server.speaks_tls(place.path());
    let near = server.url().replace("127.0.0.1", "localhost");
    let url = format!("{near}?sslmode=require");
    let ca = place.path().join("ca.pem");
    let address = PlantAddress::new(&url, None, Some(&ca)).unwrap();
    assert_eq!(Plant::prepare(&address).unwrap(), 8);
    let through = "SELECT DISTINCT ssl FROM pg_stat_ssl JOIN pg_stat_activity USING (pid) WHERE application_name = 'halfrow-station'";
    let plant = Plant::connect(&address).unwrap();
    assert_eq!(server.rows(through), [["t"]]);
    drop(plant);
    // A certificate of another authority is not accepted as the plant's.
    let other = tempfile::tempdir().unwrap();
    certificates(other.path());
    let stranger = PlantAddress::new(&url, None, Some(&other.path().join("ca.pem"))).unwrap();
    let refused = Plant::connect(&stranger).unwrap_err();
    assert!(refused.to_string().contains("is signed by nobody who is trusted"), "{refused:?}");
    assert!(refused.is_away());
    // Over a network the station does not talk to a server without TLS, whatever the address allows.
    let mut plain = Server::start();
    let far = format!("postgres://postgres@{}:{}/plant?sslmode=disable", this_computer(), plain.port());
    plain.listens_everywhere();
    let address = PlantAddress::new(&far, None, Some(&ca)).unwrap();
    let refused = Plant::connect(&address).unwrap_err();
    assert!(format!("{refused:?}").contains("does not support TLS"), "{refused:?}");
    // A file without certificates is refused at once.
    let none = PlantAddress::new(&far, None, Some(&place.path().join("names"))).unwrap_err();
    assert!(matches!(none, PlantAddressError::Trust(TrustError::NoCertificates)), "{none:?}");
}

/// An address of this computer that other computers can reach, too.
fn this_computer() -> String {
    let said = Command::new("hostname").arg("-I").output().unwrap();
    let said = String::from_utf8(said.stdout).unwrap();
    let Some(address) = said.split_whitespace().find(|name| !name.contains(':')) else {
        panic!(
            "this computer needs an IPv4 address besides 127.0.0.1, at which the server is reached from outside"
        );
    };
    address.to_owned()
}

/// A server that asks the role `halfrow` for a password.
fn guarded() -> Server {
    let server = Server::start();
    let role = format!("CREATE ROLE halfrow LOGIN SUPERUSER PASSWORD '{PASSWORD}'");
    server.change(&role);
    server.asks_for_a_password("halfrow");
    server
}

/// A station's folder, with these additional lines under `[plant]`.
fn station(server: &Server, more: &str) -> TempDir {
    let folder = crate::common::folder();
    let url = server.url().replace("postgres@", "halfrow@");
    let plant = crate::common::plant_settings(&url);
    crate::common::settings(folder.path(), "12", "data", &format!("{plant}{more}\n{LANE}"));
    folder
}

/// The exit code and output of a command with this password in its environment; no password may be printed.
fn did(folder: &TempDir, arguments: &[&str], password: Option<&str>) -> (Option<i32>, String) {
    let mut command = Command::new(program());
    command.args(arguments).args(["-vv", "--settings", "station.toml"]).current_dir(folder.path());
    if let Some(password) = password {
        command.env("HALFROW_PLANT_PASSWORD", password);
    }
    let output = command.output().unwrap();
    let said = [output.stdout, output.stderr].map(|bytes| String::from_utf8(bytes).unwrap()).concat();
    assert!(!said.contains(PASSWORD) && !said.contains(WRONG), "{said}");
    (output.status.code(), said)
}

#[test]
fn a_password_is_read_from_a_file_of_ones_own() {
    let server = guarded();
    let folder = station(&server, "password_file = \"password\"");
    let file = folder.path().join("password");
    let prepare = |password: &str, mode: u32| {
        fs::write(&file, format!("{password}\n")).unwrap();
        fs::set_permissions(&file, fs::Permissions::from_mode(mode)).unwrap();
        did(&folder, &["plant", "prepare"], None)
    };
    let (code, said) = prepare(PASSWORD, 0o644);
    assert!(code == Some(2) && said.contains("others may read"), "{said}");
    let (code, said) = prepare(WRONG, 0o600);
    assert!(code == Some(3) && said.contains("password authentication failed"), "{said}");
    let (code, said) = prepare(PASSWORD, 0o600);
    assert_eq!(code, Some(0), "{said}");
}

#[test]
fn a_password_of_the_environment_is_kept_nowhere() {
    let server = guarded();
    Plant::prepare(&server.address()).unwrap();
    let folder = station(&server, "");
    let run = "run --plan plan.toml --data data --serial CAT00001 --board mock --any-disk";
    let ran = Command::new(program()).args(run.split(' ')).current_dir(folder.path()).output().unwrap();
    assert!(ran.status.success(), "{ran:?}");
    let (code, said) = did(&folder, &["outbox", "send", "--any-disk"], Some(PASSWORD));
    assert!(code == Some(0) && said.contains("1 sent, 0 not"), "{said}");
    let data = folder.path().join("data");
    assert_eq!(query(&data, "SELECT count(*) FROM outbox WHERE done_ms IS NULL"), ["0"]);
    let kept = Command::new("grep").args(["-rl", PASSWORD]).arg(&data).output().unwrap();
    assert_eq!(String::from_utf8(kept.stdout).unwrap(), "");
}
