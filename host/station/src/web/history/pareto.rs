//! What fails most.

use axum::extract::State;
use axum::response::Response;
use maud::{Markup, html};

use super::run_filter::RunFilter;
use super::{bars, list, show, yields};
use crate::history;
use crate::history::pareto::{self, Bar, Of, Pareto};
use crate::store::Snapshot;
use crate::web::fields::Fields;
use crate::web::layout::{Here, Page};
use crate::web::state::App;
use crate::web::trouble::Trouble;
use crate::web::visit::Visit;

pub(super) async fn page(
    State(app): State<App>,
    visit: Visit,
    Fields(asked): Fields<RunFilter>,
) -> Result<Response, Trouble> {
    let asking = asked.wanted().and_then(|wanted| Ok((wanted, asked.by()?)));
    let (wanted, by) = asking.map_err(|wrong| wrong.told(&visit))?;
    let look = move |now: &Snapshot| Ok((pareto::pareto(now, &wanted, by)?, history::plan_names(now)?));
    let (found, plans) = app.look(&visit, look).await?;
    let content = html! {
        h1 { (visit.say("pareto.title")) }
        (yields::form(&visit, ("/pareto", by, word), &asked, &list::lanes(&app), &plans))
        @if found.judged == 0 {
            p.nothing { (visit.say("pareto.none")) }
        } @else {
            p.soft {
                (said(&visit, &found)) " "
                @if by == Of::Check && found.failed > 0 { (visit.say("pareto.several")) }
            }
            @if found.failed > 0 { (table(&visit, &found)) }
        }
    };
    let page = Page { here: Here::Pareto, title: visit.say("pareto.title"), head: show::head(), content };
    Ok(page.answer(&visit))
}

/// How many runs failed, of how many, and of which products.
fn said(visit: &Visit, found: &Pareto) -> Markup {
    let counts = [("runs", found.failed), ("judged", found.judged), ("units", found.units)];
    let counts = counts.map(|(name, count)| (name, count.to_string()));
    let products = found.products.join(visit.say("told.list"));
    html! {
        (visit.words.fill("pareto.failed", &counts.each_ref().map(|(name, count)| (*name, count.as_str()))))
        " " (show::said(&visit.words.fill("pareto.products", &[("products", &products)])))
    }
}

fn word(visit: &Visit, by: Of) -> &'static str {
    match by {
        Of::Part => visit.say("pareto.part"),
        Of::Check => visit.say("pareto.check"),
    }
}

fn table(visit: &Visit, found: &Pareto) -> Markup {
    let most = found.bars.first().map_or(0, |bar| bar.runs.count);
    html! {
        div.wide tabindex="0" role="region" aria-label=(visit.say("pareto.title")) { table.pareto {
            thead { tr {
                th { (visit.say("pareto.what")) } th { (visit.say("pareto.runs")) }
                th { (visit.say("pareto.share")) } th.number { (visit.say("yield.units")) }
            } }
            tbody { @for bar in &found.bars { (row(visit, bar, most)) } }
        } }
    }
}

fn row(visit: &Visit, bar: &Bar, most: u64) -> Markup {
    html! {
        tr {
            th scope="row" {
                @if bar.name.is_empty() { (visit.say("pareto.nothing")) } @else { (show::english(visit, &bar.name)) }
            }
            td { (bars::length(bar.runs.count, most)) " " (bar.runs.count) }
            td { (show::share(visit, &bar.runs)) }
            td.number { (bar.units) }
        }
    }
}
