// Runs before the page is drawn, so that it does not flash in the wrong colours.
(function () {
  'use strict';
  let kept = null;
  try {
    kept = localStorage.getItem('console-theme');
  } catch (error) {
    // Without storage the system's choice holds.
  }
  const system = window.matchMedia('(prefers-color-scheme: dark)').matches ? 'dark' : 'light';
  document.documentElement.dataset.theme = kept === 'dark' || kept === 'light' ? kept : system;
})();
