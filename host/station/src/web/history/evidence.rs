//! Evidence and exports of a run. Nothing that a board or a scanner said is ever served as a page.

use std::collections::BTreeSet;

use axum::extract::{Path, State};
use axum::http::StatusCode;
use axum::http::header::{CONTENT_DISPOSITION, CONTENT_TYPE};
use axum::response::{IntoResponse as _, Response};

use crate::export::{self, ExportError, Format};
use crate::history::unit::{self, UnitRun};
use crate::record::Attachment;
use crate::said::Said;
use crate::store::{Snapshot, StoreError};
use crate::web::state::App;
use crate::web::trouble::Trouble;
use crate::web::visit::Visit;

/// Text of any kind is shown as text.
const TEXT: &str = "text/plain; charset=utf-8";

/// Where a piece of evidence is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Whereabouts {
    Here,
    /// At the station that judged: a plant has none.
    AtStation,
    /// It was removed because it was old.
    Removed,
    /// Nobody knows.
    Lost,
}

impl Whereabouts {
    /// The attachments of the run of this id, each with where it is.
    ///
    /// # Errors
    /// [`StoreError`] when the database cannot be read.
    pub(super) fn of(
        now: &Snapshot,
        run: &str,
        attachments: Vec<Attachment>,
    ) -> Result<Vec<(Attachment, Self)>, StoreError> {
        let are_here: Vec<_> = attachments.iter().map(|one| now.has_evidence(&one.sha256)).collect();
        let removed = if are_here.contains(&false) { now.pruned_of(run)? } else { BTreeSet::new() };
        let place = |one: &Attachment, is_here: bool| {
            if is_here {
                Self::Here
            } else if removed.contains(&one.sha256) {
                Self::Removed
            } else if now.is_plant() {
                Self::AtStation
            } else {
                Self::Lost
            }
        };
        let placed = attachments.into_iter().zip(are_here).map(|(one, is_here)| {
            let place = place(&one, is_here);
            (one, place)
        });
        Ok(placed.collect())
    }
}

/// An attachment of a run by its hash.
pub(super) async fn attachment(
    State(app): State<App>,
    visit: Visit,
    Path((run, hash)): Path<(String, String)>,
) -> Result<Response, Trouble> {
    let (bytes, attachment) = attached(&app, &visit, run, hash).await?;
    let (kind, how) = served_as(&attachment.media_type);
    Ok(([(CONTENT_TYPE, kind), (CONTENT_DISPOSITION, how)], bytes).into_response())
}

/// The bytes of an attachment that this run has, and what is known of it.
///
/// # Errors
/// [`Trouble`] when the run has none of this hash, or it is not there any more.
pub(super) async fn attached(
    app: &App,
    visit: &Visit,
    run: String,
    hash: String,
) -> Result<(Vec<u8>, Attachment), Trouble> {
    let look = move |now: &Snapshot| {
        let Some(UnitRun { attachments, .. }) = unit::run_of(now, &run)? else { return Ok(None) };
        read(now, &attachments, &hash)
    };
    app.look(visit, look).await?.ok_or_else(|| Trouble::missing(visit))
}

/// The bytes of the one of `attachments` that has this hash, and what is known of it; none if none has it, or it is not there any
/// more.
pub(super) fn read(
    now: &Snapshot,
    attachments: &[Attachment],
    hash: &str,
) -> Result<Option<(Vec<u8>, Attachment)>, StoreError> {
    let Some(one) = attachments.iter().find(|one| one.sha256 == hash) else { return Ok(None) };
    match now.evidence(hash) {
        Err(StoreError::Blob(error)) if error.is_gone() => Ok(None),
        bytes => Ok(bytes?.map(|bytes| (bytes, one.clone()))),
    }
}

/// The media type that browsers are given, and whether they show the content: pictures and text, and nothing that could
/// do anything.
fn served_as(media_type: &str) -> (&'static str, &'static str) {
    match media_type.split(';').next().unwrap_or_default().trim() {
        "image/png" => ("image/png", "inline"),
        "text/plain" | "application/json" | "application/jsonl" => (TEXT, "inline"),
        _ => ("application/octet-stream", "attachment"),
    }
}

/// A run in a format for other programs.
pub(super) async fn export(
    State(app): State<App>,
    visit: Visit,
    Path((run, format)): Path<(String, String)>,
) -> Result<Response, Trouble> {
    let format = Format::named(&format).ok_or_else(|| Trouble::missing(&visit))?;
    let look = move |now: &Snapshot| {
        let run = unit::run_of(now, &run)?;
        let found = run.and_then(|run| Some((run.line.id, run.line.record_sha256?)));
        Ok(found.map(|(id, hash)| (id, export::run(now, &hash, format))))
    };
    let (id, written) = app.look(&visit, look).await?.ok_or_else(|| Trouble::missing(&visit))?;
    let bytes = written.map_err(|error| refused(&visit, error))?;
    let how = format!("attachment; filename=\"{id}{}\"", format.ending());
    Ok(([(CONTENT_TYPE, format.media()), (CONTENT_DISPOSITION, how.as_str())], bytes).into_response())
}

/// Why a run is not exported.
pub(super) fn refused(visit: &Visit, error: ExportError) -> Trouble {
    match error {
        ExportError::Store(error) => Trouble::store(visit, &error),
        error => Trouble::telling(visit, StatusCode::INTERNAL_SERVER_ERROR, &Said::of(&error)),
    }
}
