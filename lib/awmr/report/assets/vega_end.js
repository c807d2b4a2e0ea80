const vega = Object.assign({}, ...Object.values(vegaModules));
for (const name of ["transforms", "view-transforms", "encode"]) Object.assign(vega.transforms, vegaModules[`vega-${name}`]);
