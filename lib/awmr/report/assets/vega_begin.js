"use strict";
// Vega's modules refer to each other by name. They are stored here under these names, and
// vega_end.js combines them into one object. Modules that no chart uses (time, statistics, ...) are
// not included and stay empty.
const vegaModules = {};
function vegaModule(name, define) {
  const exports = {};
  define(exports, {exports}, (wanted) => vegaModules[wanted] || {});
  vegaModules[name] = exports;
}
