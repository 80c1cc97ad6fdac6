//! The runs that a filter leaves, as a table for other programs.

use std::io;

use axum::body::Body;
use axum::extract::State;
use axum::http::header::{CACHE_CONTROL, CONTENT_DISPOSITION, CONTENT_TYPE};
use axum::response::{IntoResponse as _, Response};
use futures_util::stream;

use super::evidence::refused;
use super::run_filter::RunFilter;
use crate::export::{ExportError, Table};
use crate::history::runs::{self, Cursor, Filter};
use crate::said::Said;
use crate::store::{Snapshot, StoreError};
use crate::web::fields::Fields;
use crate::web::state::App;
use crate::web::trouble::Trouble;
use crate::web::visit::Visit;

/// How many runs are read at a time. A slow reader holds neither a thread nor the store in between.
const RUNS: u32 = 200;

/// A download that is under way.
struct Download {
    app: App,
    visit: Visit,
    filter: Filter,
    /// What comes next; none after the last piece.
    next: Option<Next>,
}

enum Next {
    Piece(Vec<u8>, Option<Cursor>),
    After(Cursor),
}

/// All runs of the filter, piece by piece. A download that cannot go on breaks off, so that no part is taken for the whole.
pub(super) async fn all(
    State(app): State<App>,
    visit: Visit,
    Fields(asked): Fields<RunFilter>,
) -> Result<Response, Trouble> {
    let filter = asked.filter().map_err(|wrong| wrong.told(&visit))?;
    let (first, after) = piece(&app, &visit, &filter, None).await?;
    let download = Download { app, visit, filter, next: Some(Next::Piece(first, after)) };
    let headers = [
        (CONTENT_TYPE, "text/csv; charset=utf-8"),
        (CONTENT_DISPOSITION, "attachment; filename=\"runs.csv\""),
        (CACHE_CONTROL, "no-store"),
    ];
    Ok((headers, Body::from_stream(stream::unfold(download, further))).into_response())
}

async fn further(mut of: Download) -> Option<(io::Result<Vec<u8>>, Download)> {
    let (bytes, after) = match of.next.take()? {
        Next::Piece(bytes, after) => (bytes, after),
        Next::After(cursor) => match piece(&of.app, &of.visit, &of.filter, Some(cursor)).await {
            Ok(piece) => piece,
            // The log says why.
            Err(_) => return Some((Err(io::Error::other("the store cannot be read")), of)),
        },
    };
    of.next = after.map(Next::After);
    Some((Ok(bytes), of))
}

/// The lines of the runs that follow `after`, and the cursor after which the next piece begins. The first piece has the header.
async fn piece(
    app: &App,
    visit: &Visit,
    filter: &Filter,
    after: Option<Cursor>,
) -> Result<(Vec<u8>, Option<Cursor>), Trouble> {
    let filter = filter.clone();
    let written = move |now: &Snapshot| -> Result<_, StoreError> {
        let page = runs::page(now, &filter, after.as_ref(), RUNS)?;
        Ok(lines(now, &page, after.is_none()).map(|bytes| (bytes, page.next)))
    };
    app.look(visit, written).await?.map_err(|error| refused(visit, error))
}

/// The lines of a page of runs. The log has the run at which the table ends too early.
fn lines(now: &Snapshot, page: &runs::Page, is_first: bool) -> Result<Vec<u8>, ExportError> {
    let mut table = if is_first { Table::begin(Vec::new())? } else { Table::further(Vec::new()) };
    for (run, hash) in page.runs.iter().filter_map(|run| Some((&run.id, run.record_sha256.as_ref()?))) {
        let record = now.record(hash).map_err(ExportError::from);
        let added = record.and_then(|(record, _)| table.add(&record));
        added.inspect_err(|error| {
            tracing::error!("a table ends before the run {run}: {}", Said::of(error).with_codes());
        })?;
    }
    Ok(table.end())
}
