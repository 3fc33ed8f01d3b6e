//! The bodies of calls: parsed, then checked.

use serde::de::DeserializeOwned;

use super::parse::parse;
use super::prepare::PrepareAnew;
use crate::prelude::*;

/// The body of a call.
pub trait Document: DeserializeOwned + Limited + Send {
    /// The checked document.
    type Checked: Send + 'static;

    /// Bytes that a byte of the body takes at most once it is parsed: measured, with a margin. `{}` and a comma become
    /// a move, which is 26 bytes for each of theirs.
    const PARSED: usize = 32;

    /// Checks what the limits of single members do not say, and prepares the profile of the contact that the document
    /// defines. Faults are noted, in any case where there is no checked document.
    fn checked(self, profiles: &dyn Prepare, faults: &mut Faults) -> Option<Self::Checked>;

    /// The checked document.
    ///
    /// # Errors
    /// [`Rejection::Invalid`] with every fault, or [`Rejection::Refused`]; with
    /// [`Interrupted`](stickslip_mechanics::Error::Interrupted) if the preparation was ended.
    fn check_with(self, profiles: &dyn Prepare) -> Result<Self::Checked, Rejection> {
        let mut faults = Faults::default();
        self.check_limits(JsonPath::Root, &mut faults);
        let checked = self.checked(profiles, &mut faults);
        faults.done(checked)
    }

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

/// Documents of which the limits of their members are all that is checked.
macro_rules! checked_alone {
    ($($Name:ident),*) => {$(
        impl Document for $Name {
            type Checked = $Name;

            fn checked(self, _: &dyn Prepare, _: &mut Faults) -> Option<Self::Checked> {
                Some(self)
            }
        }
    )*};
}
pub(crate) use checked_alone;
