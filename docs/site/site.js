// What furo, the theme of the site, leaves out: dark pages on dark desktops, and what keyboards and screen readers need.

const dark = matchMedia("(prefers-color-scheme: dark)");
const all = selector => [...document.querySelectorAll(selector)];

// furo as Debian builds it lacks the rule that makes a page dark where the desktop is.
function shade() {
  const {dataset} = document.body;
  if (dataset.theme === "auto" && dark.matches) dataset.theme = "dark";
  else if (dataset.theme === "dark" && !dark.matches && localStorage.getItem("theme") !== "dark") dataset.theme = "auto";
}

// Boxes that scroll sideways take the focus, so that arrows scroll them.
function reach() {
  for (const box of all("pre, .table-wrapper")) {
    if (box.scrollWidth > box.clientWidth) box.tabIndex = 0;
    else box.removeAttribute("tabindex");
  }
}

function name(selector, attributes) {
  for (const element of all(selector))
    for (const [key, value] of Object.entries(attributes)) element.setAttribute(key, value);
}

// The icon of a label that opens a sidebar, as a button.
function press(label) {
  const icon = label.querySelector(".icon");
  icon.tabIndex = 0;
  icon.setAttribute("role", "button");
  icon.setAttribute("aria-label", label.textContent.trim());
  icon.addEventListener("keydown", event => {
    if (event.key !== "Enter" && event.key !== " ") return;
    event.preventDefault();
    label.click();
  });
}

addEventListener("DOMContentLoaded", () => {
  shade();
  dark.addEventListener("change", shade);
  name("[role=heading]:not([aria-level])", {"aria-level": "2"});
  name(".sidebar-drawer", {"aria-label": "All pages"});
  name(".toc-drawer", {"aria-label": "On this page"});
  name(".content-icon-container", {role: "region", "aria-label": "View"});
  name(".overlay", {"aria-hidden": "true"});
  all(".nav-overlay-icon, .toc-overlay-icon").forEach(press);
  for (const head of all("th").filter(head => !head.textContent.trim())) {
    const cell = document.createElement("td");
    head.replaceWith(cell);
  }
  if (!document.querySelector("h1")) {
    const title = document.createElement("h1");
    title.textContent = document.title;
    (document.querySelector("[role=main]") ?? document.body).prepend(title);
  }
  reach();
  addEventListener("resize", reach);
});
