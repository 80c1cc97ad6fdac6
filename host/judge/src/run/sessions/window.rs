//! Looks at the window of a board that refused a row as beyond it, or did not bring one back however often it was sent.

use crate::result::Finding;
use crate::run::findings::End;
use crate::run::rules::window_wrong;
use crate::run::steps::Run;

/// How often the window must be wrong.
const TIMES: u32 = 2;

impl Run<'_> {
    /// What the run ends with that ended with `end`. The refusal of a row for want of credit proves nothing: the host may know a
    /// window from another session, or an old RESET may have taken it down. Nor does a row that does not come back: the window may
    /// have kept back the row that pushes it out of the core, or the link may lose it. But no link changes how far ahead a board's
    /// own answer to a RESET sets the window.
    pub(crate) fn told_of_window(&mut self, end: End) -> End {
        let is_of_row = matches!(
            end.finding(),
            Finding::RowLostEachTime(_) | Finding::RowLostAmongOthers { .. } | Finding::RowStayedAway(_)
        );
        if !end.is_without_credit() && !is_of_row {
            return end;
        }
        let banks = u32::from(self.board.capabilities.row_banks_in);
        let credits: Vec<_> = (0..TIMES)
            .map_while(|_| self.board.credit_for_new_rows().ok())
            .take_while(|&rows| rows != banks)
            .collect();
        match credits.last() {
            Some(&rows) if credits.len() == TIMES as usize => {
                End::failed(end.check(), window_wrong(self.board.last_request(), banks, rows))
            }
            _ => end,
        }
    }
}
