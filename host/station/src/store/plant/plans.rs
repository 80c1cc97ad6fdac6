//! Plans that the plant publishes, as engineers have signed them.

use super::super::database::{DatabaseError, Row, values};
use super::super::{Deed, Snapshot, StoreError, statements as sql};
use super::Plant;
use crate::clock;
use crate::plan::PlanName;
use crate::published::{Bundle, Signed, Statement};

impl Plant {
    /// The statement that holds for this plan. The caller decides whether to trust it.
    ///
    /// # Errors
    /// [`StoreError`] when the plant cannot be read.
    pub fn publication(&mut self, plan: &PlanName) -> Result<Option<Signed>, StoreError> {
        let PlanName { product, plan } = plan;
        self.carry_out("to tell a plan", |from| from.first(sql::PUBLICATION, values![product, plan], signed))
    }

    /// Like [`Self::publication`], the last statement about this version.
    ///
    /// # Errors
    /// Like [`Self::publication`].
    pub(crate) fn published_version(
        &mut self,
        plan: &PlanName,
        version: &str,
    ) -> Result<Option<Signed>, StoreError> {
        let PlanName { product, plan } = plan;
        self.carry_out("to tell a plan's versions", |from| {
            from.first(sql::PUBLISHED_VERSION, values![product, plan, version], signed)
        })
    }

    /// The text of the bundle of this hash; empty if there is none.
    ///
    /// # Errors
    /// Like [`Self::publication`].
    pub fn bundle(&mut self, sha256: &str) -> Result<String, StoreError> {
        let found = self
            .carry_out("to give a plan", |from| from.first(sql::BUNDLE, values![sha256], |row| row.get(0)))?;
        Ok(found.unwrap_or_default())
    }

    /// Makes the statement hold from now on. `bundle` is its plan, which the plant needs unless it has it, and replaces what the
    /// plant has under its hash. Returns whether the statement was the next one: somebody else may have been quicker.
    ///
    /// # Errors
    /// [`StoreError`] when the plant does not take it.
    pub fn publish(
        &mut self,
        statement: &Statement,
        signature: &str,
        bundle: Option<&Bundle>,
    ) -> Result<bool, StoreError> {
        let Statement { product, name, version, sha256, number, operator, reason, .. } = statement;
        let text = statement.text();
        let at_ms = clock::now_ms();
        let subject = format!("{product}/{name} {version}");
        let deed = Deed { operator, act: "publish plan", subject: &subject, detail: reason };
        self.audited("to publish a plan", deed, |to| {
            if let Some(bundle) = bundle {
                to.execute(sql::ADD_BUNDLE, values![sha256, &bundle.text()])?;
            }
            to.execute(
                sql::PUBLISH,
                values![product, name, *number, version, sha256, &text, signature, at_ms],
            )
        })
    }
}

fn signed(row: &Row<'_>) -> Result<Signed, DatabaseError> {
    Ok(Signed { statement: row.get(0)?, signature: row.get(1)? })
}

/// The statements that hold, ordered by product and name, and since when, in milliseconds since 1970, UTC. What this program
/// cannot read is left out.
///
/// # Errors
/// [`StoreError`] when the plant cannot be read.
pub(crate) fn publications(of: &Snapshot) -> Result<Vec<(Statement, i64)>, StoreError> {
    let rows: Vec<(String, i64)> =
        of.rows("to tell its plans", sql::PUBLICATIONS, &[], |row| Ok((row.get(0)?, row.get(1)?)))?;
    Ok(rows
        .into_iter()
        .filter_map(|(text, at_ms)| Some((serde_json::from_str(&text).ok()?, at_ms)))
        .collect())
}
