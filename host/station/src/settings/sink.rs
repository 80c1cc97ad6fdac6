//! `[[sink]]`: who else is sent what the station keeps.

use std::path::{Path, PathBuf};

use axum::http::Uri;
use axum::http::uri::Authority;
use toml::Spanned;
use ureq::{Proxy, ProxyProtocol};

use super::read::{file, is_name};
use super::text::SinkText;
use crate::export::Format;
use crate::input_error::{At, Fault};
use crate::store::SINK_OF_PLANT;
use crate::trust;

/// The most characters of a sink's name.
const MOST_NAME: usize = 32;

/// A `[[sink]]`
#[derive(Clone, Debug)]
pub struct SinkSettings {
    /// Its name, by which the outbox keeps what it has.
    pub name: String,
    /// Where it is.
    pub to: Destination,
}

/// Where results are sent to.
#[derive(Clone, Debug)]
pub enum Destination {
    /// A folder, which gets a file for each.
    Folder {
        /// The folder.
        path: PathBuf,
        /// What runs are written as.
        format: Format,
    },
    /// A web server, which gets a request for each.
    Post {
        /// Where it is.
        address: SinkAddress,
        /// What runs are written as.
        format: Format,
        /// The file with the token that lets the station in.
        token: Option<PathBuf>,
        /// The proxy that connects the station with the server. It sees neither requests nor answers.
        proxy: Option<Proxy>,
    },
    /// A broker of MQTT, which gets an event for each.
    Events {
        /// Where it is; topics begin with its path.
        address: SinkAddress,
        /// How the station logs in.
        login: Option<Login>,
    },
}

/// How the station logs in at a broker.
#[derive(Clone, Debug)]
pub struct Login {
    /// The name.
    pub user: String,
    /// The file with the password.
    pub password: PathBuf,
}

/// The address of a sink.
#[derive(Clone, Debug)]
pub struct SinkAddress {
    /// The whole address.
    pub url: String,
    /// The host.
    pub host: String,
    /// The port.
    pub port: u16,
    /// The path after them.
    pub path: String,
    /// Whether it goes through TLS.
    pub is_protected: bool,
    /// The file of certificates that sign the server's; those of the system if there is none.
    pub ca: Option<PathBuf>,
}

/// The schemes of a way to send, in clear and by TLS, and the default port of each.
type Schemes = [(&'static str, u16); 2];

const HTTP: Schemes = [("http", 80), ("https", 443)];
const MQTT: Schemes = [("mqtt", 1883), ("mqtts", 8883)];

impl SinkSettings {
    /// What the settings say, in a file whose folder is `folder`.
    pub(super) fn of(folder: &Path, text: &SinkText) -> Result<Self, Fault> {
        let name = name(&text.name)?;
        let path = |name: &Option<Spanned<String>>| name.as_ref().map(|name| file(folder, name)).transpose();
        let format = text.format.as_ref().map(|format| *format.get_ref());
        let ca = path(&text.ca)?;
        let (to, used) = match (&text.folder, &text.post, &text.mqtt) {
            (Some(to), None, None) => {
                let path = file(folder, to)?;
                (Destination::Folder { path, format: format.unwrap_or_default() }, ["format"].as_slice())
            }
            (None, Some(url), None) => {
                let (address, token) = (address(url, HTTP, ca)?, path(&text.token_file)?);
                let (format, proxy) = (format.unwrap_or_default(), proxy(text.proxy.as_ref(), &address)?);
                let to = Destination::Post { address, format, token, proxy };
                (to, ["format", "token_file", "ca", "proxy"].as_slice())
            }
            (None, None, Some(url)) => {
                let address = address(topics(url)?, MQTT, ca)?;
                let events = Destination::Events { address, login: login(folder, text)? };
                (events, ["user", "password_file", "ca"].as_slice())
            }
            _ => {
                let what = format!("the sink {name} has not one place to send to");
                let remedy = "write one of folder, post and mqtt";
                return Err(Fault::wrong(&text.name, what, remedy));
            }
        };
        match text.unused(used) {
            Some((key, at)) => {
                Err(Fault::wrong(at, format!("{key} says nothing to this sink"), "leave it out"))
            }
            None => Ok(Self { name, to }),
        }
    }
}

impl SinkText {
    /// The first key that is given and is not one of `used`, with its place.
    fn unused(&self, used: &[&str]) -> Option<(&'static str, usize)> {
        let at = |text: &Option<Spanned<String>>| text.as_ref().map(At::at);
        let given = [
            ("format", self.format.as_ref().map(At::at)),
            ("token_file", at(&self.token_file)),
            ("user", at(&self.user)),
            ("password_file", at(&self.password_file)),
            ("ca", at(&self.ca)),
            ("proxy", at(&self.proxy)),
        ];
        // Every key by name: a new one, which the compiler names here, is among those above or says where a sink is.
        let Self {
            name: _,
            folder: _,
            post: _,
            mqtt: _,
            format: _,
            token_file: _,
            user: _,
            password_file: _,
            ca: _,
            proxy: _,
        } = self;
        given.into_iter().find_map(|(key, at)| Some((key, at?)).filter(|(key, _)| !used.contains(key)))
    }
}

fn name(text: &Spanned<String>) -> Result<String, Fault> {
    let name = text.get_ref();
    if is_name(name, MOST_NAME) && name != SINK_OF_PLANT {
        return Ok(name.clone());
    }
    let what = format!("`{name}` is no name for a sink");
    let remedy =
        format!("write 1 to {MOST_NAME} letters, digits and hyphens; {SINK_OF_PLANT} is the plant's");
    Err(Fault::wrong(text, what, remedy))
}

fn login(folder: &Path, text: &SinkText) -> Result<Option<Login>, Fault> {
    match (&text.user, &text.password_file) {
        (None, None) => Ok(None),
        (Some(user), Some(password)) => {
            Ok(Some(Login { user: user.get_ref().clone(), password: file(folder, password)? }))
        }
        (one, other) => {
            let at = one.as_ref().or(other.as_ref()).map_or(0, At::at);
            Err(Fault::wrong(at, "a user and a password belong together", "write user and password_file"))
        }
    }
}

/// The address of a broker, unless its path, with which every topic begins, is not fit for topics.
fn topics(url: &Spanned<String>) -> Result<&Spanned<String>, Fault> {
    if !url.get_ref().contains(['+', '#', '?']) {
        return Ok(url);
    }
    let what = "topics begin with the path of this address, and no topic may have `+`, `#` or `?` here";
    Err(Fault::wrong(url, what, "leave them out"))
}

/// The proxy to a server at `to`. What goes through a proxy leaves this computer, so it must be protected.
fn proxy(text: Option<&Spanned<String>>, to: &SinkAddress) -> Result<Option<Proxy>, Fault> {
    let Some(text) = text else { return Ok(None) };
    let wrong = |what, remedy| Fault::wrong(text, what, remedy);
    if !to.is_protected {
        let what = "results would go openly through a proxy";
        return Err(wrong(what, "write https:// in post, or leave proxy out"));
    }
    let no_proxy =
        || wrong("this is no proxy that is asked without a password", "write it as http://host:port");
    let uri: Uri = text.get_ref().parse().map_err(|_| no_proxy())?;
    let authority = uri.authority().filter(|authority| !authority.as_str().contains('@'));
    let (Some("http"), Some(authority), "/") = (uri.scheme_str(), authority, uri.path()) else {
        return Err(no_proxy());
    };
    let port = port(authority, HTTP[0].1).ok_or_else(no_proxy)?;
    let proxy = Proxy::builder(ProxyProtocol::Http).host(authority.host()).port(port);
    proxy.build().map(Some).map_err(|_| no_proxy())
}

/// The port of an address without a user; `default` if it names none, or an empty one. None if it names one that no computer has.
fn port(authority: &Authority, default: u16) -> Option<u16> {
    let is_bare = authority.as_str().trim_end_matches(':') == authority.host();
    if is_bare { Some(default) } else { authority.port_u16() }
}

/// The address of a sink. What leaves this computer goes through TLS, and no address has a password.
fn address(
    text: &Spanned<String>,
    [open, protected]: Schemes,
    ca: Option<PathBuf>,
) -> Result<SinkAddress, Fault> {
    let url = text.get_ref();
    let wrong = |what: String, remedy: String| Fault::wrong(text, what, remedy);
    let example = format!("write it as {}://host/path", protected.0);
    let none = || wrong("this is no address".to_owned(), example.clone());
    let uri: Uri = url.parse().map_err(|_| none())?;
    let (Some(scheme), Some(authority)) = (uri.scheme_str(), uri.authority()) else {
        return Err(wrong("this is no whole address".to_owned(), example));
    };
    let Some((scheme, default)) = [open, protected].into_iter().find(|(name, _)| *name == scheme) else {
        return Err(wrong(format!("nothing is sent by {scheme}"), example));
    };
    if authority.as_str().contains('@') {
        let what = "anybody may see who and with what password who sees these settings";
        return Err(wrong(what.to_owned(), "write it into a file of its own, and its name here".to_owned()));
    }
    let port = port(authority, default).ok_or_else(none)?;
    let is_protected = scheme == protected.0;
    if !is_protected && !trust::is_near(authority.host()) {
        let what = format!("{scheme} would send results openly to {}", authority.host());
        return Err(wrong(what, format!("write {}://", protected.0)));
    }
    Ok(SinkAddress {
        url: url.clone(),
        host: authority.host().to_owned(),
        port,
        path: uri.path().to_owned(),
        is_protected,
        ca,
    })
}
