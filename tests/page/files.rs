//! Files on the page: what each column was taken for is shown before anything is fitted, and a refusal names its place.

use crate::axe;
use crate::ball;
use crate::browser::Browser;
use crate::common::Binary;

const CARD: &str = "document.querySelector('#loop-card').innerText";
/// The cells of the table of columns.
const TABLE: &str = "[...document.querySelectorAll('#loop-card .columns tbody tr')].map((row) => [...row.cells].map(\
                     (cell) => cell.innerText).join(' | '))";

#[tokio::test]
async fn the_columns_of_a_file_are_named_before_it_is_fitted_and_a_refused_unit_can_be_chosen() {
    let server = Binary::start(&[]);
    let session = ball(&server).await;
    let browser = Browser::start(1280, 900, false).await;
    browser.page.goto(&format!("{}/#/contacts/{}/loop", server.address, session.id)).await.unwrap();
    browser.find("textarea[name=loop]").await;
    let upload = async |name: &str| {
        browser.upload("#loop-card input[type=file]", &format!("tests/lab_files/{name}")).await;
    };
    upload("loop_coefficient_first.csv").await;
    browser.until(&format!("{TABLE}.length === 5")).await;
    for (row, texts) in [(2, ["left out", "coefficient"]), (3, ["force, in N", "Friction force (N)"])] {
        let shown = browser.value(&format!("{TABLE}[{row}]")).await;
        for text in texts {
            assert!(shown.as_str().unwrap().to_lowercase().contains(&text.to_lowercase()), "{shown}: {text}");
        }
    }
    assert!(browser.value(CARD).await.as_str().unwrap().contains("Lines that are not in it: 1."));
    axe::assert_readable(&browser, "columns").await;

    // A unit that lost its first character: named by line, column and text, and chosen here.
    upload("loop_unit_question.csv").await;
    browser
        .until(&format!(
            "{CARD}.includes('line 1, column 1') && {CARD}.includes('“?m”') && {CARD}.includes('choose the unit below')"
        ))
        .await;
    browser.until(&format!("{TABLE}.length === 0")).await;
    let choose = "(() => { const unit = document.querySelector('[aria-label=\"Unit of displacement\"]'); unit.value = \
                  '-6'; unit.dispatchEvent(new Event('change', { bubbles: true })); })() ?? null";
    browser.value(choose).await;
    browser.until(&format!("{TABLE}.some((row) => row.includes('displacement, in um'))")).await;

    // Another unit than those of the list stays that of the file when a column is chosen.
    upload("loop_unit_mils.csv").await;
    browser.until(&format!("{TABLE}.some((row) => row.includes('displacement, in mil'))")).await;
    let column = "(() => { const box = document.querySelector('[aria-label=\"Column of displacement\"]'); box.value = \
                  '1'; box.dispatchEvent(new Event('change', { bubbles: true })); })() ?? null";
    browser.value(column).await;
    browser.until(&format!("{TABLE}.some((row) => row.includes('displacement, in mil'))")).await;
    browser.click("#compute-loop").await;
    let friction = "[...document.querySelectorAll('#loop-estimates div')].find((row) => \
                    row.innerText.includes('friction'))?.innerText ?? ''";
    browser.until(&format!("({friction}).includes('0.3 (95 %')")).await;
    browser.stayed_quiet_and_at(&server.address, &["status of 422"]).await;
    browser.close().await;
}
