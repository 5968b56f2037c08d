// A table that sorts by the column whose heading is clicked. columns: [{title, value(row), show(row), text: bool, low: better?}].
function table(container, columns, rows, sort) {
  const body = html("tbody");
  const headings = columns.map((c, i) => html("th", { scope: "col", tabindex: 0, text: c.title, onclick: () => sortBy(i),
    onkeydown: (e) => { if (e.key === "Enter") sortBy(i); } }));
  const best = columns.map((c) => (c.low ? Math.min(...rows.map(c.value).filter((v) => v !== null)) : null));
  function fill() {
    const { column, down } = sort;
    const key = columns[column].value;
    // What has no value comes last, whichever way the others are sorted.
    const order = rows.slice().sort((a, b) => {
      const [x, y] = [key(a), key(b)];
      if (x === null || y === null) return (x === null) - (y === null);
      return (x < y ? -1 : x > y ? 1 : 0) * (down ? -1 : 1);
    });
    body.replaceChildren(...order.map((row) => html("tr", {}, ...columns.map((c, i) => {
      const cell = html("td", {}, ...[].concat(c.show(row)));
      if (best[i] !== null && c.value(row) === best[i]) cell.className = "best";
      return cell;
    }))));
    headings.forEach((h, i) => {
      if (i === column) h.setAttribute("aria-sort", down ? "descending" : "ascending");
      else h.removeAttribute("aria-sort");
    });
  }
  function sortBy(i) {
    sort.down = sort.column === i ? !sort.down : false;
    sort.column = i;
    fill();
  }
  fill();
  container.replaceChildren(html("thead", {}, html("tr", {}, ...headings)), body);
}
