//! What the answers to greetings say, in their headers too.

use halfrow_protocol::message::{Refusal, Welcome};
use halfrow_protocol::{Header, Kind};

use super::{Rules, broken};
use crate::board::{BoardError, Response};
use crate::result::{Answer, CheckName, Finding, Identity, Rule};
use crate::run::findings::End;
use crate::verdict::Cause;

impl Rules<'_, '_> {
    /// The answer to the last greeting, which opened a session, must say who the board is, as the first one did, and be the first
    /// packet of that session, in which no row has entered.
    pub(super) fn same_board_greets(&mut self) -> Result<(), End> {
        let (welcome, Header { session, window, .. }) = (self.run.board.welcome, self.run.board.answered());
        self.same_board(&welcome)?;
        let banks = self.capabilities.row_banks_in.into();
        if session != welcome.session {
            return Err(another_session(Rule::NewSession, welcome.session, session));
        }
        if window != banks {
            // Another build of the same commit may have other banks.
            self.has_tables()?;
            let [right, found] = [banks, window].map(|rows| Answer::Credit { rows });
            return Err(broken(Rule::NewSession, Kind::Hello, right, found));
        }
        Ok(())
    }

    /// The answer `welcome` must say who the board is, as the first one did. One that names another board may come from
    /// another board, unless the tables are still there.
    pub(super) fn same_board(&mut self, welcome: &Welcome) -> Result<(), End> {
        let Some(first) = &self.run.findings.board.identity else { return Ok(()) };
        let now = Identity::of(welcome, &self.capabilities);
        let [right, found] = [first, &now].map(|Identity { build, serial, .. }| Answer::Replied {
            payload: format!("build {build} and serial number {serial}"),
        });
        if right == found {
            return Ok(());
        }
        self.has_tables()?;
        Err(broken(Rule::NewSession, Kind::Hello, right, found))
    }

    /// A board without tables may be another one than the board that was given them.
    fn has_tables(&mut self) -> Result<(), End> {
        if self.status()?.generation == 0 {
            return Err(End::error(CheckName::Identity, Cause::Refused, Finding::BoardExchanged {}));
        }
        Ok(())
    }

    /// What is `said` to a greeting must be the refusal that is `right`, and that in no session.
    pub(super) fn greeting_refused(
        &mut self,
        rule: Rule,
        said: Result<Response, BoardError>,
        right: Refusal,
    ) -> Result<(), End> {
        let Header { session, .. } = self.run.board.answered();
        self.judge(rule, Kind::Hello.into(), said, &Response::Refused(right))?;
        if session == 0 { Ok(()) } else { Err(another_session(Rule::RefusalSession, 0, session)) }
    }
}

pub(super) fn another_session(rule: Rule, right: u8, found: u8) -> End {
    let [right, found] = [right, found].map(|number| Answer::Session { number });
    broken(rule, Kind::Hello, right, found)
}
