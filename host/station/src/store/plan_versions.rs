//! Plans of one name and version that are not the same: nobody can tell their runs apart in a yield.

use super::database::values;
use super::{Store, StoreError, statements};
use crate::plan::Plan;

impl Store {
    /// The hash of another plan with the product, name and version of this one, by which runs were judged here.
    ///
    /// # Errors
    /// [`StoreError`] when the database cannot be read.
    pub(crate) fn other_of_version(&mut self, plan: &Plan) -> Result<Option<String>, StoreError> {
        let of = values![&plan.product, &plan.name, &plan.version, &plan.sha256];
        self.read("to tell its plans", |from| from.first(statements::PLAN_OF_VERSION, of, |row| row.get(0)))
    }
}
