//! Following a job: how it stands, whenever that has changed.

use std::time::Duration;

use futures::Stream;
use tokio::sync::{OwnedSemaphorePermit, watch};
use uuid::Uuid;

use stickslip_wire::{EndReason, JobReply, JobState};

use super::{JobError, Jobs};

/// How long a listener waits for changes that no other process tells it of.
const LOOK: Duration = Duration::from_secs(1);
/// How long a listener rests after each event: chunks may come faster than anybody reads.
const REST: Duration = Duration::from_millis(100);

/// What happens to a job.
#[derive(Clone, Debug, PartialEq)]
pub enum Happening {
    /// It stands so.
    Progress(JobReply),
    /// Nothing more will be told, though it has not ended.
    End(EndReason),
}

struct Listener {
    jobs: Jobs,
    id: Uuid,
    last: Option<JobReply>,
    woken: watch::Receiver<()>,
    ending: watch::Receiver<bool>,
    over: bool,
    // Gives the place back when the listener goes, in whatever way.
    _place: OwnedSemaphorePermit,
}

impl Jobs {
    /// How a job stands, and then whenever that has changed, until it has ended.
    ///
    /// # Errors
    /// [`JobError::NotFound`], [`JobError::TooManyStreams`], or a failure of the store.
    pub async fn events(&self, id: Uuid) -> Result<impl Stream<Item = Happening> + Send + use<>, JobError> {
        let place = self.common.streams.clone().try_acquire_owned().map_err(|_| JobError::TooManyStreams)?;
        // Before the first look, so that no change falls between it and the first wait.
        let woken = self.common.store.changes().subscribe(id);
        self.own(id).await?;
        let ending = self.common.ending.subscribe();
        let listener = Listener { jobs: self.clone(), id, last: None, woken, ending, over: false, _place: place };
        Ok(futures::stream::unfold(listener, Listener::next))
    }

    /// Ends all events, present and future, and all work on jobs: the process is about to stop.
    pub fn end(&self) {
        self.common.ending.send_replace(true);
    }
}

impl Listener {
    async fn next(mut self) -> Option<(Happening, Listener)> {
        if self.over {
            return None;
        }
        if self.last.is_some() {
            self.pause(REST).await;
        }
        let happening = loop {
            if *self.ending.borrow() {
                break Happening::End(EndReason::Stopping);
            }
            match self.jobs.get(self.id).await {
                Ok(job) if self.last.as_ref() != Some(&job) => break Happening::Progress(job),
                Err(JobError::NotFound(_)) => break Happening::End(EndReason::Deleted),
                Ok(_) | Err(_) => self.wait().await,
            }
        };
        match &happening {
            Happening::Progress(job) => {
                self.over = job.state != JobState::Running;
                self.last = Some(job.clone());
            }
            Happening::End(_) => self.over = true,
        }
        Some((happening, self))
    }

    async fn wait(&mut self) {
        let gone = tokio::select! {
            changed = self.woken.changed() => changed.is_err(),
            () = tokio::time::sleep(LOOK) => false,
            _ = self.ending.wait_for(|ending| *ending) => false,
        };
        if gone {
            self.pause(LOOK).await;
        }
    }

    async fn pause(&mut self, time: Duration) {
        tokio::select! {
            () = tokio::time::sleep(time) => {}
            _ = self.ending.wait_for(|ending| *ending) => {}
        }
    }
}
