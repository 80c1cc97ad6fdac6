//! What two stations of a plant bound differently.

use maud::{Markup, html};

use super::run_filter::unit_address;
use super::show;
use crate::history::mismatch::{Bound, Mismatch};
use crate::web::visit::Visit;

/// A table of them under its title; nothing if there are none.
pub(in crate::web) fn table<'a>(visit: &Visit, mismatches: impl IntoIterator<Item = &'a Mismatch>) -> Markup {
    let mut rows = mismatches.into_iter().peekable();
    html! {
        @if rows.peek().is_some() {
            h2 { (visit.say("mismatch.title")) }
            p.soft { (visit.say("mismatch.about")) }
            div.wide tabindex="0" role="region" aria-label=(visit.say("mismatch.title")) { table.bindings {
                thead { tr {
                    th { (visit.say("nav.station")) } th { (visit.say("history.device")) }
                    th { (visit.say("mismatch.judged")) } th { (visit.say("history.last")) }
                    th { (visit.say("mismatch.bound")) }
                } }
                tbody { @for one in rows { (row(visit, one)) } }
            } }
        }
    }
}

fn row(visit: &Visit, one: &Mismatch) -> Markup {
    let Bound { device, serial, from_ms, station, .. } = &one.bound;
    html! {
        tr {
            td { (show::said(&one.station)) }
            td { code { (one.device) } }
            td { a href=(unit_address(&one.serial)) { (show::said(&one.serial)) } }
            td { a href=(show::run_address(&one.run)) { (show::moment(one.last_ms)) } }
            td {
                a href=(unit_address(serial)) { (show::said(serial)) } " · " code { (device) } " · " (show::moment(*from_ms)) " · "
                @match station {
                    Some(station) => { (show::said(station)) }
                    None => { (visit.say("mismatch.person")) }
                }
            }
        }
    }
}
