//! The station's pages: what lanes do, while they do it, and what was judged.
//!
//! ```text
//!  browser ──► serve ──► request_guard ──► a line of the table of routes ──► page or act
//!              limits    Host, Origin, login, CSRF                            │        │
//!                                                                             ▼        ▼
//!                                                                   snapshot of store  engine
//!  engine's news ──► live ──► server-sent events of every page that is open
//! ```

mod access;
mod assets;
mod connection_slots;
mod etag;
mod fields;
mod history;
mod jobs;
pub(crate) mod language;
mod layout;
mod live;
mod login;
mod metrics;
mod operator;
mod outbox;
mod plant;
mod request_guard;
mod routes;
mod serve;
mod state;
mod trouble;
mod visit;
mod write_timeout;

pub use access::{Access, Role, Scope};
pub(crate) use access::{TokenError, Tokens, UserError, Users, add_token, add_user};
pub use routes::{Route, Who, routes};
pub(crate) use serve::PagesEnded;
pub use serve::{ServeError, Server};
pub use state::App;
pub use visit::User;
