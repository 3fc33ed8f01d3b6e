//! The bodies of calls: parsed, then checked.

use serde::de::DeserializeOwned;

use super::check::Rejection;
use super::definition::DefinedProfile;
use super::parse::parse;
use super::prepare::{Prepare, PrepareAnew};

/// The body of a call.
pub trait Document: DeserializeOwned + Send {
    /// The checked document.
    type Checked: Send + 'static;

    /// Checks every number against its range, and prepares the profile of the contact that the document defines.
    ///
    /// # Errors
    /// [`Rejection::Invalid`] with every fault, or [`Rejection::Refused`]; with
    /// [`Interrupted`](stickslip_mechanics::Error::Interrupted) if the preparation was ended.
    fn check_with(self, profiles: &dyn Prepare) -> Result<Self::Checked, Rejection>;

    /// The same with a profile that is made anew, however long that takes.
    ///
    /// # Errors
    /// As [`Document::check_with`].
    fn check(self) -> Result<Self::Checked, Rejection> {
        self.check_with(&PrepareAnew)
    }

    /// The profile that the check prepares.
    fn profile(&self) -> Option<DefinedProfile<'_>> {
        None
    }
}

/// Parses and checks a body.
///
/// # Errors
/// [`Rejection`] by [`parse()`] and by [`Document::check`].
pub fn read<T: Document>(body: &[u8]) -> Result<T::Checked, Rejection> {
    parse::<T>(body)?.check()
}
