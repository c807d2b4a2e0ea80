"use strict";
// Vega's modules refer to each other by name. They are stored here by name, and vega_end.js combines them into
// one object. A module that is not included, because no chart uses it (time, statistics, ...), is empty.
const vegaModules = {};
function vegaModule(name, define) {
  const exports = {};
  define(exports, {exports}, (wanted) => vegaModules[wanted] || {});
  vegaModules[name] = exports;
}
