"use strict";
// Vega's modules refer to each other by name. They are stored here and combined into one object in
// vega_end.js. Modules that no chart uses (times, statistics, selections) are empty.
const vegaModules = {};
function vegaModule(name, define) {
  const exports = {};
  define(exports, {exports}, (wanted) => vegaModules[wanted] || {});
  vegaModules[name] = exports;
}
