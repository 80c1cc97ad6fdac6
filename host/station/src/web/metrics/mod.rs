//! Figures of a station or of a plant, for Prometheus and other programs that read its formats.
//!
//! Their labels have no serial number, no unit and nobody's name, so the number of series depends only on plans and lanes.

mod of_plant;
mod of_station;
mod text;
mod turns;

use std::collections::BTreeMap;

use axum::extract::State;
use axum::http::HeaderMap;
use axum::http::header::{CACHE_CONTROL, CONTENT_TYPE};
use axum::response::{IntoResponse as _, Response};

use self::text::{Format, Label, Metric, Text, info};
use super::routes::{Route, Who, look};
use super::state::App;
use super::trouble::Trouble;
use super::visit::Visit;
use crate::history::counts::{Cell, Count};

pub(super) use self::turns::Turns;

pub(super) fn routes() -> Vec<Route> {
    vec![look("/metrics", Who::Reader, metrics)]
}

async fn metrics(State(app): State<App>, visit: Visit, headers: HeaderMap) -> Result<Response, Trouble> {
    let format = Format::asked(&headers);
    let mut text = Text::new(format);
    text.of(&BUILD).put(&[("version", halfrow::VERSION)], 1);
    if app.is_plant() {
        of_plant::write(&mut text, &app, &visit).await;
    } else {
        of_station::write(&mut text, &app, &visit).await?;
    }
    let headers = [(CONTENT_TYPE, format.media_type()), (CACHE_CONTROL, "no-store")];
    Ok((headers, text.end()).into_response())
}

const BUILD: Metric = info("halfrow_build", "The program's version, with the commit that it was built from.");

/// Writes runs by verdict, units, and units that passed at first, as these three metrics; `labels` are those of a cell.
fn counted(
    text: &mut Text,
    [by_verdict, units, first_passed]: [&Metric; 3],
    counts: &BTreeMap<Cell, Count>,
    labels: fn(&Cell) -> [Label<'_>; 3],
) {
    let mut of = text.of(by_verdict);
    for (cell, count) in counts {
        let [first, second, third] = labels(cell);
        for (verdict, runs) in [("PASS", count.passed), ("FAIL", count.failed), ("ERROR", count.errors)] {
            of.put(&[first, second, third, ("verdict", verdict)], runs);
        }
    }
    let mut of = text.of(units);
    for (cell, count) in counts {
        of.put(&labels(cell), count.units);
    }
    let mut of = text.of(first_passed);
    for (cell, count) in counts {
        of.put(&labels(cell), count.first_passed);
    }
}
