//! The exhibits as one self-contained page, in the style of the reports.

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use maud::{Markup, html};
use png::EncodingError;

use super::exhibit::{Cell, Claim, Drawing, Exhibit, Picture, Table};
use super::folder::{encoded, file_name};
use super::outcome::Outcome;
use halfrow::report;

/// The page of `exhibits`, in their order.
///
/// # Errors
/// The PNG encoder's.
pub(super) fn render(exhibits: &[Exhibit]) -> Result<String, EncodingError> {
    let sections = exhibits.iter().map(section).collect::<Result<Vec<_>, _>>()?;
    let body = html! {
        (banner(exhibits))
        main { @for section in sections { (section) } }
    };
    Ok(report::html_document("The paper, reproduced by halfrow", &body).into_string())
}

/// The overall result, and what could not be tried.
fn banner(exhibits: &[Exhibit]) -> Markup {
    let claims: Vec<&Claim> = exhibits.iter().flat_map(|exhibit| &exhibit.claims).collect();
    let accepted = claims.iter().filter(|claim| claim.holds()).count();
    let open = exhibits.iter().map(|exhibit| exhibit.open.len()).sum::<usize>();
    let outcome = Outcome::of(exhibits);
    html! {
        header.(outcome.class()) {
            p.verdict { (outcome.word(!claims.is_empty())) }
            h1 {
                @if claims.is_empty() { "No number was held to the paper" }
                @else {
                    (accepted) " of " (claims.len()) " numbers that were tried are accepted"
                }
                @if open > 0 { ", " (open) " not tried" }
            }
            @for open in exhibits.iter().flat_map(|exhibit| &exhibit.open) { p.facts { "Not tried: " (open) } }
            p.facts {
                "Lai et al., Real-time distortion correction of fish-eye lens based on Bayer image signal, Optical Review "
                "2014, reproduced by halfrow " (env!("CARGO_PKG_VERSION")) "."
            }
        }
    }
}

fn section(exhibit: &Exhibit) -> Result<Markup, EncodingError> {
    let pictures = exhibit.pictures.iter().map(figure).collect::<Result<Vec<_>, _>>()?;
    Ok(html! {
        section id=(exhibit.item.name()) {
            h2 { (exhibit.item.title()) }
            @for remark in &exhibit.remarks { p { (remark) } }
            @for open in &exhibit.open { p.remedy { (open) } }
            @if !exhibit.claims.is_empty() { (claims(&exhibit.claims)) }
            @if !pictures.is_empty() {
                div.previews.threes[exhibit.in_threes] { @for picture in pictures { (picture) } }
            }
            @for table in &exhibit.tables { (numbers(table)) }
        }
    })
}

fn claims(claims: &[Claim]) -> Markup {
    html! {
        div.scroll { table {
            thead { tr {
                th {} th { "number" } th.number { "paper" } th.number { "found" } th.number { "deviation" }
                th { "accepted" }
            } }
            tbody { @for claim in claims { (row(claim)) } }
        } }
    }
}

fn row(claim: &Claim) -> Markup {
    let (class, word) = match (claim.holds(), claim.judges_board) {
        (true, _) => ("ok", "ok"),
        (false, true) => ("fail", "FAIL"),
        (false, false) => ("error", "MISSED"),
    };
    html! {
        tr {
            td { span.mark.(class) { (word) } }
            td { (claim.what) }
            td.number { @if let Some(paper) = claim.paper { (paper) " " (claim.unit) } }
            td.number { (claim.printed()) " " (claim.unit) }
            td.number { @if let Some(deviation) = claim.deviation() { (format!("{deviation:+.4}")) } }
            td { (claim.condition()) }
        }
    }
}

fn figure(picture: &Picture) -> Result<Markup, EncodingError> {
    let bytes = STANDARD.encode(encoded(picture)?);
    let (kind, class) = match picture.drawing {
        Drawing::Pixels(_, zoom) => ("png", (zoom > 1).then_some("samples")),
        Drawing::Lines(_) => ("svg+xml", None),
    };
    let source = format!("data:image/{kind};base64,{bytes}");
    Ok(html! {
        figure {
            img class=[class] src=(source) alt=(picture.caption);
            figcaption { (picture.caption) " " (file_name(picture)) }
        }
    })
}

fn numbers(table: &Table) -> Markup {
    let class = |cell: &Cell| matches!(cell, Cell::Number(..)).then_some("number");
    let classes = table.rows.first().into_iter().flatten().map(class);
    let heads: Vec<_> = table.columns.iter().zip(classes).collect();
    html! {
        h3 { (table.caption) }
        p.legend { (table.name) ".csv" }
        @if table.on_page {
            div.scroll { table.frames {
                thead { tr { @for (name, class) in &heads { th class=[class] { (name) } } } }
                tbody { @for row in &table.rows {
                    tr { @for cell in row { td class=[class(cell)] { (cell.text()) } } }
                } }
            } }
        }
    }
}
