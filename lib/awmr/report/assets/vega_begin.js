"use strict";
// Vega comes as modules that ask for each other by name. They are kept here and made into one object at the end.
const vegaModules = {};
function vegaModule(name, define) {
  const exports = {};
  define(exports, {exports}, (wanted) => vegaModules[wanted.replace(/selections$/, "selection")]);
  vegaModules[name] = exports;
}
