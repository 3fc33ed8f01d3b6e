//! What is drawn over a loop, and the link that carries the view.

use serde_json::{Value, json};
use stickslip_wire::client::Options;
use stickslip_wire::{CreateRequest, Move, MoveRequest};

use crate::browser::Browser;
use crate::common::{Binary, create};
use crate::{ball, moved};

/// The points of a line of a plot, in pixels.
async fn line(browser: &Browser, plot: &str, kind: &str) -> Vec<[f64; 2]> {
    let way = format!(
        "document.querySelector('#plot-{plot} .line.{kind}').getAttribute('d').slice(1).split(/[LM]/)\
         .map((p) => p.split(',').map(Number))"
    );
    serde_json::from_value(browser.value(&way).await).unwrap()
}

/// How far a point is from the nearest corner of a line, in pixels.
fn off(point: &[f64; 2], line: &[[f64; 2]]) -> f64 {
    line.iter().map(|place| (place[0] - point[0]).hypot(place[1] - point[1])).fold(f64::INFINITY, f64::min)
}

#[tokio::test]
async fn a_measured_file_and_another_contact_are_drawn_over_the_loop_and_a_link_carries_the_view() {
    let server = Binary::start(&[]);
    let session = ball(&server).await;
    let twin = CreateRequest { label: Some("Its twin".to_owned()), ..create() };
    let twin = server.client.create(&twin, &Options::default()).await.unwrap();
    for contact in [&session, &twin] {
        moved(&server, contact, &[0.9, -0.6, 0.3]).await;
    }
    let states = server.client.history(session.id, None, None).await.unwrap().items;
    // The same states as a rig would record them: the time first, in µm and mN, with decimal commas and a gap.
    let row = |index: usize, u: f64, f: f64| format!("{index};{};{}\n", u * 1e6, f * 1e3).replace('.', ",");
    let rows = states.iter().enumerate().map(|(index, item)| row(index, item.state.displacement, item.state.force));
    let table = format!("# rig\nTime (s);Displacement (um);Force (mN)\n{}9;;\n", rows.collect::<String>());

    let browser = Browser::start(1280, 900, false).await;
    browser.page.goto(&format!("{}/#/contacts/{}", server.address, session.id)).await.unwrap();
    browser.until("document.querySelector('#plot-loop .line.past')?.getAttribute('d').split('L').length > 20").await;
    let drop = format!(
        "(() => {{ const data = new DataTransfer(); data.items.add(new File([{}], 'rig_loop.csv')); \
         document.querySelector('#plot-loop svg').dispatchEvent(new DragEvent('drop', \
         {{ dataTransfer: data, bubbles: true, cancelable: true }})); }})() ?? null",
        json!(table)
    );
    browser.value(&drop).await;
    browser.until("document.querySelector('#overlay-said')?.innerText === '3 points of rig_loop.csv.'").await;
    browser.until("document.querySelector('#plot-loop .line.file') !== null").await;
    let (past, file) = (line(&browser, "loop", "past").await, line(&browser, "loop", "file").await);
    assert_eq!(file.len(), 3);
    for point in &file {
        assert!(off(point, &past) < 0.1, "{point:?} is not on the path that it was read from");
    }
    // In another unit it is elsewhere.
    let other_unit = "(() => { const unit = document.querySelector('[aria-label=\"Unit of measured force\"]'); \
                      unit.value = '0'; unit.dispatchEvent(new Event('change', { bubbles: true })); })() ?? null";
    browser.value(other_unit).await;
    browser
        .until(
            "Number(document.querySelectorAll('#plot-loop .level line').length) === 2 && \
                   [...document.querySelectorAll('#plot-loop .grid text')].some((text) => Number(text.textContent) >= \
                   1)",
        )
        .await;
    browser.click("#overlay button").await;
    browser.until("document.querySelector('#plot-loop .line.file') === null").await;

    // The twin has the same loop and the same stress, until it is moved.
    browser.value("(document.querySelector('#overlay').open = true) && null").await;
    browser.until("document.querySelectorAll('#compare option').length === 2").await;
    let compare = format!(
        "(() => {{ const list = document.querySelector('#compare'); list.value = '{}'; \
         list.dispatchEvent(new Event('change')); }})() ?? null",
        twin.id
    );
    browser.value(&compare).await;
    browser
        .until(
            "document.querySelector('#plot-loop .line.other') !== null && document.querySelector('#plot-stress \
        .line.other') !== null",
        )
        .await;
    browser.until(&format!("location.hash.includes('with={}')", twin.id)).await;
    let (past, twins) = (line(&browser, "loop", "past").await, line(&browser, "loop", "other").await);
    for end in [&twins[0], twins.last().unwrap()] {
        assert!(off(end, &[past[0], *past.last().unwrap()]) < 0.1, "{end:?}");
    }
    let (tau, twins_tau) = (line(&browser, "stress", "tau").await, line(&browser, "stress", "other").await);
    assert!(twins_tau.iter().all(|point| off(point, &tau) < 0.1));
    browser.picture("compared").await;
    let gone = Move::displacement(-0.9 * session.contact.gross_slip_displacement);
    server.client.apply(twin.id, &MoveRequest::from(gone), &Options::default()).await.unwrap();
    browser
        .until(&format!(
            "(() => {{ const way = document.querySelector('#plot-loop .line.other').getAttribute('d').split('L'); \
                            return Number(way.at(-1).split(',')[0]) < {}; }})()",
            past.last().unwrap()[0] - 20.0
        ))
        .await;

    // Zoom, a line switched off, a unit, and the contact compared with are in the address.
    browser.drag("#plot-loop svg", 0.4, 0.7).await;
    browser.click("#plot-loop .key.past").await;
    let choose = "(() => { const unit = document.querySelector('#unit-displacement'); unit.value = '-6'; \
                  unit.dispatchEvent(new Event('change')); })() ?? null";
    browser.value(choose).await;
    let ticks = "[...document.querySelectorAll('#plot-loop .grid text')].map((text) => text.textContent).join()";
    browser.until("document.querySelector('#plot-loop .line.past') === null").await;
    let zoomed = browser.value(ticks).await;
    let link = browser.value("location.href").await.as_str().unwrap().to_owned();
    browser.page.goto(&format!("{}/#/", server.address)).await.unwrap();
    browser.find(".list").await;
    browser.page.goto(&link).await.unwrap();
    browser
        .until(
            "document.querySelector('.badge.on') !== null && document.querySelector('#plot-loop .line.other') !== null",
        )
        .await;
    browser.until(&format!("{ticks} === {zoomed}")).await;
    assert_eq!(browser.value("document.querySelector('#plot-loop .line.past')").await, Value::Null);
    assert_eq!(browser.value("document.querySelector('#unit-displacement').value").await, "-6");
    assert_eq!(browser.value("document.querySelector('#plot-loop .key.past').ariaPressed").await, "false");
    // By keyboard the whole plot is shown again, and the address says so.
    browser.press("#plot-loop svg", "0").await;
    browser.until("!location.hash.includes('loop=') && location.hash.includes('loop-off=')").await;
    browser.look(400, 850, true).await;
    browser.until("document.documentElement.scrollWidth <= innerWidth").await;
    browser.picture("compared-narrow").await;
    browser.stayed_quiet_and_at(&server.address, &[]).await;
    browser.close().await;
}
