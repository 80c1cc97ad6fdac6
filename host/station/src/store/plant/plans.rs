//! Plans that the plant publishes, as engineers have signed them.

use super::super::database::values;
use super::super::{Snapshot, StoreError, statements as sql};
use super::Plant;
use crate::clock;
use crate::history::PlanName;
use crate::published::{Bundle, Statement};

impl Plant {
    /// What holds for this plan: the statement's text, and its signature. Whether it is to be trusted is for whoever asks.
    ///
    /// # Errors
    /// [`StoreError`] when the plant cannot be read.
    pub fn publication(&mut self, plan: &PlanName) -> Result<Option<(String, String)>, StoreError> {
        let PlanName { product, plan } = plan;
        self.carry_out("to tell a plan", |from| {
            from.first(sql::PUBLICATION, values![product, plan], |row| Ok((row.get(0)?, row.get(1)?)))
        })
    }

    /// As [`Self::publication`], what was said last of this version.
    ///
    /// # Errors
    /// As [`Self::publication`].
    pub fn published_version(
        &mut self,
        plan: &PlanName,
        version: &str,
    ) -> Result<Option<(String, String)>, StoreError> {
        let PlanName { product, plan } = plan;
        self.carry_out("to tell a plan's versions", |from| {
            let values = values![product, plan, version];
            from.first(sql::PUBLISHED_VERSION, values, |row| Ok((row.get(0)?, row.get(1)?)))
        })
    }

    /// The text of the bundle of this hash; empty if there is none.
    ///
    /// # Errors
    /// As [`Self::publication`].
    pub fn bundle(&mut self, sha256: &str) -> Result<String, StoreError> {
        let found = self
            .carry_out("to give a plan", |from| from.first(sql::BUNDLE, values![sha256], |row| row.get(0)))?;
        Ok(found.unwrap_or_default())
    }

    /// From now on what the statement says holds; `bundle` is its plan, unless the plant has it, and takes the place of what the plant has
    /// under its hash. Returns whether it was the next one: somebody else may have been quicker.
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
        self.audited(operator, "publish plan", &subject, reason, |to| {
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

/// What holds, by product and name, and since when in milliseconds since 1970, UTC. What is no statement of this program's is left out.
///
/// # Errors
/// [`StoreError`] when the plant cannot be read.
pub fn publications(of: &Snapshot) -> Result<Vec<(Statement, i64)>, StoreError> {
    let rows: Vec<(String, i64)> =
        of.rows("to tell its plans", sql::PUBLICATIONS, &[], |row| Ok((row.get(0)?, row.get(1)?)))?;
    Ok(rows
        .into_iter()
        .filter_map(|(text, at_ms)| Some((serde_json::from_str(&text).ok()?, at_ms)))
        .collect())
}
