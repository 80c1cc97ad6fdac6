//! The operator's page in Chromium.

mod chromium;
mod live;
mod look;
mod proxied;
mod scans;
