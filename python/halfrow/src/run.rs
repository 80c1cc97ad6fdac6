//! A finished run.

use std::path::PathBuf;

use halfrow::report::{self, wording};
use halfrow::{Finished, ReportFolder};
use pyo3::prelude::*;
use pyo3::types::PyType;

use crate::{arguments, errors, outputs};

/// What a run found, from which halfrow/_report.py makes a Report.
#[pyclass(frozen, module = "halfrow")]
pub(crate) struct Run {
    pub(crate) finished: Finished,
}

#[pymethods]
impl Run {
    /// The whole result as JSON, as `halfrow schema` describes it.
    fn json(&self) -> PyResult<String> {
        report::json(&self.finished.report).map_err(errors::failed)
    }

    /// A copy shares the same frames.
    fn __copy__(this: Bound<'_, Self>) -> Bound<'_, Self> {
        this
    }

    fn __deepcopy__<'py>(this: Bound<'py, Self>, _memo: Bound<'py, PyAny>) -> Bound<'py, Self> {
        this
    }

    /// Pickled, it becomes None: its frames stay in this process.
    fn __reduce__(this: Bound<'_, Self>) -> (Bound<'_, PyType>, ()) {
        let py = this.py();
        (py.None().into_bound(py).get_type(), ())
    }

    /// The verdict, every check, the suspects, and what to do: one line each.
    fn text(&self) -> String {
        wording::summary(&self.finished.report)
    }

    /// Writes report.json, report.xml (JUnit) and report.html into the folder `path`.
    fn save(
        &self,
        py: Python<'_>,
        #[pyo3(from_py_with = arguments::folder)] path: PathBuf,
        overwrite: bool,
    ) -> PyResult<()> {
        outputs::check_report(&path, overwrite)?;
        let Finished { report, evidence } = &self.finished;
        py.detach(|| ReportFolder::prepare(&path, overwrite)?.commit(report, evidence))
            .map_err(errors::failed)
    }
}
