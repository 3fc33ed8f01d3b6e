//! Sweeps and their jobs through the typed client.

use reqwest::{Method, StatusCode};
use uuid::Uuid;

use super::{Client, Error, Options, json, read, sent, with};
use crate::{JobReply, SweepReply, SweepRequest};

/// The answer to a sweep.
#[derive(Clone, Debug, PartialEq)]
pub enum Swept {
    /// Its table.
    Table(SweepReply),
    /// A job that computes it.
    Job(JobReply),
}

impl Client {
    /// `POST /sweep`.
    pub async fn sweep(&self, request: &SweepRequest, options: &Options) -> Result<Swept, Error> {
        let (status, body) = sent(with(self.call(Method::POST, "/sweep").json(request), options)).await?;
        if status == StatusCode::ACCEPTED {
            read(status, &body).map(Swept::Job)
        } else {
            read(status, &body).map(Swept::Table)
        }
    }

    /// `GET /jobs/{id}`.
    pub async fn job(&self, id: Uuid) -> Result<JobReply, Error> {
        json(self.call(Method::GET, &format!("/jobs/{id}"))).await
    }

    /// `GET /jobs/{id}/result`.
    pub async fn job_result(&self, id: Uuid) -> Result<SweepReply, Error> {
        json(self.call(Method::GET, &format!("/jobs/{id}/result"))).await
    }

    /// `DELETE /jobs/{id}`.
    pub async fn delete_job(&self, id: Uuid) -> Result<(), Error> {
        sent(self.call(Method::DELETE, &format!("/jobs/{id}"))).await.map(drop)
    }
}
