//! Making profiles ready while documents are checked: a table takes time for it, which must be counted, may end, and
//! need not be spent twice.

use std::cell::RefCell;
use std::sync::Arc;

use stickslip_mechanics::Elasticity;
use stickslip_mechanics::profile::Profile as Shape;

use crate::prelude::*;

/// Makes the profiles of documents ready for the mechanics: anew, or shared with other documents.
pub trait Prepare {
    /// The profile of a document for these bodies: one that is ready, or else what `prepare` makes, if the document is
    /// without fault. Anew each time, unless an implementation shares them.
    fn profile(
        &self,
        _document: &Profile,
        _bodies: Option<&Elasticity>,
        prepare: &mut dyn FnMut() -> Option<Shape>,
    ) -> Option<Arc<Shape>> {
        prepare().map(Arc::new)
    }

    /// Asked every few milliseconds of preparation, which ends once this has returned false.
    fn keep_going(&self) -> bool;
}

/// Every profile anew, however long it takes.
#[derive(Clone, Copy, Debug)]
pub struct PrepareAnew;

impl Prepare for PrepareAnew {
    fn keep_going(&self) -> bool {
        true
    }
}

/// A document, the moduli that its profile belongs to, and the profile.
type Prepared = (Profile, Option<Elasticity>, Arc<Shape>);

/// The same profile as for the document before, if it is the same document.
pub struct PrepareOnce<'a> {
    inner: &'a dyn Prepare,
    last: RefCell<Option<Prepared>>,
}

impl<'a> PrepareOnce<'a> {
    /// Prepares by `inner`.
    pub fn by(inner: &'a dyn Prepare) -> PrepareOnce<'a> {
        PrepareOnce { inner, last: RefCell::default() }
    }
}

impl Prepare for PrepareOnce<'_> {
    fn profile(
        &self,
        document: &Profile,
        bodies: Option<&Elasticity>,
        prepare: &mut dyn FnMut() -> Option<Shape>,
    ) -> Option<Arc<Shape>> {
        let bodies_of_profile = bodies.filter(|_| document.depends_on_bodies());
        if let Some((last, of, shape)) = &*self.last.borrow()
            && last == document
            && of.as_ref() == bodies_of_profile
        {
            return Some(Arc::clone(shape));
        }
        let shape = self.inner.profile(document, bodies, prepare)?;
        *self.last.borrow_mut() = Some((document.clone(), bodies_of_profile.copied(), Arc::clone(&shape)));
        Some(shape)
    }

    fn keep_going(&self) -> bool {
        self.inner.keep_going()
    }
}
