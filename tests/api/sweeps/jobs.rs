//! Jobs: how they are requested, watched, bounded and cancelled.

use futures::StreamExt as _;
use reqwest::Method;
use serde_json::{Value, json};
use stickslip::admission::{Capacity, Pool, QuotaLimits};

use super::{long, small_job};
use crate::common::{PATIENCE, Server, ball, problem, until, with};

/// The events of a stream to its end: names and data.
async fn events(response: reqwest::Response) -> Vec<(String, Value)> {
    use eventsource_stream::Eventsource as _;
    assert_eq!(response.status(), 200);
    assert_eq!(response.headers()["content-type"], "text/event-stream");
    let events = response.bytes_stream().eventsource().map(|event| {
        let event = event.unwrap();
        (event.event, serde_json::from_str(&event.data).unwrap())
    });
    tokio::time::timeout(PATIENCE, events.collect()).await.expect("the events did not end")
}

#[tokio::test]
async fn a_large_sweep_becomes_a_job_and_a_small_one_if_that_is_wanted() {
    let server = Server::start().await;
    // Much work for its size; it is not waited for.
    let response = server.post("/sweep", &long(200_000)).await;
    assert_eq!(response.status(), 202);
    let path = response.headers()["location"].to_str().unwrap().to_owned();
    let job: Value = response.json().await.unwrap();
    assert_eq!(path, format!("/jobs/{}", job["id"].as_str().unwrap()));
    assert_eq!(
        (&job["state"], &job["progress"]),
        (&json!("running"), &json!({"points": 200_000, "done": 0, "failed": 0}))
    );
    let early = problem(server.get(&format!("{path}/result")).await).await;
    assert_eq!((early.status, early.code.as_str()), (409, "job_not_done"));
    assert_eq!(server.send(Method::DELETE, &path, None, &[]).await.status(), 204);

    let mut small = small_job();
    let by_member = server.start_job(&small).await;
    small["job"] = json!(false);
    let preferred =
        server.send(Method::POST, "/sweep", Some(&small.to_string()), &[("prefer", "wait=5, respond-async")]).await;
    assert_eq!(
        (preferred.status().as_u16(), &preferred.headers()["preference-applied"]),
        (202, &"respond-async".parse().unwrap())
    );
    let by_header = preferred.headers()["location"].to_str().unwrap().to_owned();
    let at_once = server.post("/sweep", &small).await.text().await.unwrap();
    for path in [by_member, by_header] {
        assert_eq!(server.job_result(&path).await, at_once);
        let job = server.job(&path).await;
        let time = |name: &str| job[name].as_str().unwrap().parse::<jiff::Timestamp>().unwrap();
        assert_eq!(time("expires_at").duration_since(time("finished_at")).as_hours(), 24, "kept for a day");
    }
}

#[tokio::test]
async fn events_lead_from_the_beginning_to_the_end_of_a_job() {
    let server = Server::start().await;
    let stream =
        server.send(Method::POST, "/sweep", Some(&long(40_000).to_string()), &[("accept", "text/event-stream")]).await;
    let events = events(stream).await;
    let (last, before) = events.split_last().unwrap();
    assert!(before.iter().all(|(name, _)| name == "progress"), "{events:?}");
    let done: Vec<u64> = events.iter().map(|(_, job)| job["progress"]["done"].as_u64().unwrap()).collect();
    assert!(done.is_sorted() && done.last() == Some(&40_000), "{done:?}");
    assert_eq!((last.0.as_str(), &last.1["state"]), ("done", &json!("done")));
    // A client that connects later receives the end at once.
    let path = format!("/jobs/{}", last.1["id"].as_str().unwrap());
    let late = self::events(server.get(&format!("{path}/events")).await).await;
    assert_eq!(late, [("done".to_owned(), last.1.clone())]);
    assert!(server.job_result(&path).await.starts_with("{\"points\":40000,"));
}

#[tokio::test]
async fn a_cancelled_job_is_gone_with_its_result() {
    let server = Server::start().await;
    let path = server.start_job(&long(300_000)).await;
    let stream = server.get(&format!("{path}/events")).await;
    until("a part is done", async || (server.job(&path).await["progress"]["done"].as_u64() > Some(0)).then_some(()))
        .await;
    assert_eq!(server.send(Method::DELETE, &path, None, &[]).await.status(), 204);
    let events = events(stream).await;
    assert_eq!(events.last().unwrap(), &("end".to_owned(), json!({"reason": "deleted"})));
    for (method, more) in [(Method::GET, ""), (Method::GET, "/result"), (Method::GET, "/events"), (Method::DELETE, "")]
    {
        let refusal = problem(server.send(method, &format!("{path}{more}"), None, &[]).await).await;
        assert_eq!((refusal.status, refusal.code.as_str()), (404, "job_not_found"), "{more}");
    }
    assert_eq!(problem(server.get("/jobs/none").await).await.code, "job_not_found");
    // Its threads are free for others.
    let path = server.start_job(&small_job()).await;
    server.job_result(&path).await;
}

#[tokio::test]
async fn jobs_are_bounded_in_work_until_some_are_gone() {
    let server = Server::start().await;
    let mut heavy = long(2_000_000);
    heavy["base"]["path"]["falling_amplitude"]["reversals"] = json!(13_000);
    let (mut paths, mut refused) = (Vec::new(), None);
    for _ in 0..10 {
        let response = server.post("/sweep", &heavy).await;
        if response.status() == 429 {
            refused = Some(response);
            break;
        }
        paths.push(response.headers()["location"].to_str().unwrap().to_owned());
    }
    let refused = refused.expect("work without bounds");
    assert!(refused.headers().contains_key("retry-after"));
    let refusal = problem(refused).await;
    assert!(refusal.code == "too_many_jobs" && refusal.detail.contains("work"), "{refusal:?}");
    for path in &paths {
        assert_eq!(server.send(Method::DELETE, path, None, &[]).await.status(), 204);
    }
    // By the number of jobs `access.rs` has them refused.
    server.start_job(&heavy).await;
}

/// Its outputs include the time that it has taken, which no other computation repeats.
#[tokio::test]
async fn a_sweep_answered_at_once_honours_its_key() {
    let server = Server::start().await;
    let mut sweep = small_job();
    sweep["job"] = json!(false);
    sweep["outputs"] = json!(["/residual/max", "/accuracy/compute_time"]);
    let ask = async |key: &str, sweep: &Value, path: &str, header: (&str, &str)| {
        let headers = [("idempotency-key", key), header];
        server.send(Method::POST, path, Some(&sweep.to_string()), &headers).await
    };
    let plain = ("accept", "*/*");
    let first = ask("small", &sweep, "/sweep", plain).await;
    assert_eq!(first.status(), 200);
    let first = first.text().await.unwrap();
    // Also to one that would rather have a job, and in another format.
    for header in [plain, ("prefer", "respond-async")] {
        let again = ask("small", &sweep, "/sweep", header).await;
        assert_eq!((again.status().as_u16(), again.text().await.unwrap()), (200, first.clone()), "{header:?}");
    }
    let rows = ask("small", &sweep, "/sweep?format=rows", plain).await.json::<Vec<Value>>().await.unwrap();
    let first: Value = serde_json::from_str(&first).unwrap();
    for (index, row) in rows.iter().enumerate() {
        for (name, value) in row.as_object().unwrap() {
            assert_eq!(*value, first["columns"][name][index], "{name}");
        }
    }
    // Another request may not have its key, and it may not have that of another one.
    let other = with(sweep.clone(), "/axes/0/values/0", json!(0.15));
    assert_eq!(problem(ask("small", &other, "/sweep", plain).await).await.code, "idempotency_key_reused");
    assert_eq!(problem(ask("small", &ball(), "/contacts", plain).await).await.code, "idempotency_key_reused");
    assert_eq!(ask("contact", &ball(), "/contacts", plain).await.status(), 201);
    assert_eq!(problem(ask("contact", &sweep, "/sweep", plain).await).await.code, "idempotency_key_reused");
    // A retry of a job gets the job, whatever it prefers.
    let job = ask("job", &sweep, "/sweep", ("prefer", "respond-async")).await;
    let again = ask("job", &sweep, "/sweep", plain).await;
    assert_eq!((job.status().as_u16(), again.status().as_u16()), (202, 202));
    assert_eq!(job.headers()["location"], again.headers()["location"]);
    // What is too large to be kept for a retry becomes a job, whose result is kept.
    let mut large = long(70_000);
    large["base"]["path"] = json!({"displacement": [1e-7]});
    assert_eq!(server.post("/sweep", &large).await.status(), 200);
    assert_eq!(ask("large", &large, "/sweep", plain).await.status(), 202);
}

#[tokio::test]
async fn tables_that_are_kept_for_retries_count_against_the_quota() {
    let quotas = QuotaLimits { store_bytes: 2_000, ..QuotaLimits::default() };
    let pool = Pool::new(Capacity { quotas, ..Capacity::default() });
    let server = Server::in_pool(pool).await;
    let mut sweep = small_job();
    sweep["job"] = json!(false);
    let ask = async |key: String| {
        let headers = [("idempotency-key", &*key)];
        server.send(Method::POST, "/sweep", Some(&sweep.to_string()), &headers).await
    };
    let mut kept = 0;
    let refused = loop {
        let response = ask(format!("{kept:0>200}")).await;
        if response.status() != 200 {
            break problem(response).await;
        }
        kept += 1;
        assert!(kept < 4, "{kept} replies of some 700 bytes");
    };
    assert_eq!((refused.code.as_str(), kept > 0), ("quota_exceeded", true));
    assert_eq!(server.post("/sweep", &sweep).await.status(), 200, "nothing is kept without a key");
}
