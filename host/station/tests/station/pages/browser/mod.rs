//! The operator's page in Chromium.

mod axe;
mod chromium;
mod figures;
mod live;
mod look;
mod proxied;
mod read;
mod scans;
mod told;
