// What the theme leaves out for readers with a screen reader or a keyboard.
document.addEventListener("DOMContentLoaded", () => {
  for (const caption of document.querySelectorAll('.caption[role="heading"]:not([aria-level])')) caption.setAttribute("aria-level", "2");
  const reach = () => {
    for (const box of document.querySelectorAll("pre, .table-wrapper, .math-wrapper, .equation")) {
      const scrolls = box.scrollWidth > box.clientWidth || box.scrollHeight > box.clientHeight;
      if (scrolls && !box.hasAttribute("tabindex")) {
        box.tabIndex = 0;  // an arrow key scrolls what has the focus
        box.setAttribute("role", "region");
        box.setAttribute("aria-label", box.matches("pre") ? "Code, scrolls" : box.matches(".table-wrapper") ? "Table, scrolls" : "Equation, scrolls");
      }
    }
  };
  reach();
  window.addEventListener("resize", reach);
});
