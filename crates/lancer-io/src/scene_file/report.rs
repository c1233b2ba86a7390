//! Problems at places, told as diagnostics of files.

use super::build::Warning;
use super::overrides::Override;
use super::syntax::{Origin, Problem};
use crate::diagnostics::{Diagnostic, LoadError};
use crate::limits::Limits;
use std::path::Path;

/// What is needed to tell where a problem is.
pub(crate) struct Report<'a> {
    file: &'a Path,
    /// `None` where there is no file, only overrides.
    text: Option<&'a str>,
    overrides: &'a [Override],
    /// The most errors that are told, and the most warnings; at least 1.
    pub(crate) most: usize,
}

impl<'a> Report<'a> {
    pub(crate) fn of_file(file: &'a Path, text: &'a str, overrides: &'a [Override], limits: &Limits) -> Self {
        Self { file, text: Some(text), overrides, most: limits.errors.max(1) }
    }

    pub(crate) fn of_overrides(overrides: &'a [Override], limits: &Limits) -> Self {
        Self { file: Path::new("--set"), text: None, overrides, most: limits.errors.max(1) }
    }

    /// The problems in the order of their places, each once.
    pub(crate) fn error(&self, mut problems: Vec<Problem>) -> LoadError {
        problems.sort_by_key(|problem| problem.place);
        let mut told = Vec::<&Problem>::new();
        for problem in &problems {
            // What is shared by aliases or built in two variants is found at fault more than once.
            let repeats =
                told.iter().rev().take_while(|last| last.place == problem.place).any(|last| *last == problem);
            if !repeats {
                told.push(problem);
            }
        }
        let more = told.len().saturating_sub(self.most);
        let mut diagnostics =
            told.iter().take(self.most).map(|problem| self.diagnostic(problem)).collect::<Vec<_>>();
        if told.len() >= self.most {
            // A reader stops when it has found enough, and cannot know how many more there are.
            let rest = if more > 0 {
                format!("{more} more errors are not shown")
            } else {
                "there may be more errors".into()
            };
            diagnostics.push(Diagnostic::new(self.file, rest));
        }
        LoadError { diagnostics }
    }

    /// The warnings in the order in which they came up.
    pub(crate) fn warnings(&self, warnings: Vec<Warning>) -> Vec<Diagnostic> {
        let more = warnings.len().saturating_sub(self.most);
        let told = warnings.into_iter().take(self.most).map(|warning| match warning {
            Warning::Here(problem) => self.diagnostic(&problem),
            Warning::Elsewhere(diagnostic) => diagnostic,
        });
        let rest =
            (more > 0).then(|| Diagnostic::new(self.file, format!("{more} more warnings are not shown")));
        told.chain(rest).collect()
    }

    fn diagnostic(&self, problem: &Problem) -> Diagnostic {
        let mut diagnostic = match (problem.place.origin, self.text) {
            (Origin::File, Some(text)) => Diagnostic::new(self.file, &problem.message)
                .at(problem.place.line as usize, problem.place.column as usize)
                .showing(text),
            (Origin::File, None) => Diagnostic::new(self.file, &problem.message),
            (Origin::Override(index), _) => {
                Diagnostic::new(self.overrides[index as usize].to_string(), &problem.message)
            }
        };
        diagnostic.hint.clone_from(&problem.hint);
        diagnostic
    }
}
