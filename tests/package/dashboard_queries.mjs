// Prints what the dashboards ask Prometheus: a line each of dashboard, panel and expression, tabs between them, the variable
// `instance` filled in as Grafana does for All.
import { readFileSync, readdirSync } from "node:fs";

const folder = process.argv[2];
for (const file of readdirSync(folder).filter((name) => name.endsWith(".json"))) {
  const dashboard = JSON.parse(readFileSync(`${folder}/${file}`, "utf8"));
  for (const panel of dashboard.panels) {
    for (const target of panel.targets) {
      if (target.expr) console.log([dashboard.uid, panel.title, target.expr.replaceAll("$instance", ".*")].join("\t"));
    }
  }
}
