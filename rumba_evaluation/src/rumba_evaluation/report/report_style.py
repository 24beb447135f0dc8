"""The style sheet of a mission's report, and its colours beside those of the figures."""

from rumba_sim.model.maps.floor_colours import ROBOTS

STYLE = '''
*{box-sizing:border-box}
body{margin:0 auto;padding:1rem;max-width:66rem;font:1rem/1.5 system-ui,-apple-system,"Segoe UI",sans-serif;
color:var(--ink);background:var(--page)}
h1{font-size:1.5rem;margin:0;overflow-wrap:anywhere}
h2{font-size:1.1rem;margin:0 0 .5rem}
header p,footer,.note{color:var(--soft);margin:.25rem 0 0;overflow-wrap:anywhere}
.tiles{display:grid;grid-template-columns:repeat(2,1fr);gap:.75rem;margin:1rem 0;padding:0}
.tiles div,section{background:var(--card);border:1px solid var(--rule);border-radius:.5rem;padding:.75rem 1rem}
.tiles dt{color:var(--soft);font-size:.85rem}
.tiles dd{margin:0;font-size:1.5rem;line-height:1.3}
.tiles dd small{display:block;color:var(--soft);font-size:.85rem}
.outcome{border-left:.3rem solid;background:var(--card);padding:.5rem 1rem;margin:1rem 0;font-size:1.2rem;
overflow-wrap:anywhere}
.columns{display:grid;grid-template-columns:repeat(auto-fit,minmax(min(100%,26rem),1fr));gap:.75rem;align-items:start;
margin-bottom:.75rem}
.columns>div{display:grid;gap:.75rem}
.path{margin-bottom:.75rem}
.path label{font-size:.85rem;white-space:nowrap}
.path figure{clear:both}
#bumps:not(:checked)~figure #map-bumps{display:none}
#slider{display:flex;flex-wrap:wrap;align-items:center;gap:.25rem .75rem;margin:.25rem 0}
#slider[hidden]{display:none}
#slider input{flex:1 1 14rem;min-width:0;accent-color:var(--main)}
#slider button{font:inherit;color:inherit;background:var(--page);border:1px solid var(--faint);border-radius:.35rem;
min-width:4.5rem;padding:.15rem .6rem;cursor:pointer}
#slider output{flex:1 1 100%;color:var(--soft);font-size:.9rem;font-variant-numeric:tabular-nums}
.at{font:inherit;color:var(--main);background:none;border:0;padding:.35rem 0;min-height:2rem;cursor:pointer;
text-decoration:underline}
section{min-width:0}
figure{margin:0}
svg,img{display:block;width:100%;height:auto;max-height:90vh}
svg *{stroke-linejoin:round;stroke-linecap:butt}
svg text{font-family:inherit!important}
img{background:#fff}
.map{max-height:85vh}
@media (max-width:40rem){svg.map text{font-size:15px!important}}
.legend{list-style:none;display:flex;flex-wrap:wrap;gap:.1rem 1rem;margin:.5rem 0 0;padding:0;font-size:.85rem}
.legend b{font-weight:400}
.legend i{display:inline-block;width:.8em;height:.8em;border-radius:.15em;margin-right:.35em}
.legend .line{height:.2em;vertical-align:.25em;width:1.2em}
.legend .floor{background:var(--swept);border-radius:.15em;padding:0 .25em;margin-right:.35em}
.legend .cell{border:1px solid var(--faint)}
image.dark{display:none}
@media screen and (prefers-color-scheme:dark){image.dark{display:inline}image.light{display:none}}
table{border-collapse:collapse;width:100%;font-size:.9rem}
th,td{text-align:left;vertical-align:top;padding:.25rem .5rem .25rem 0;border-bottom:1px solid var(--rule)}
td:first-child,th[scope=row]{white-space:nowrap}
th[scope=row]{font-weight:400;color:var(--soft)}
td{overflow-wrap:anywhere}
.team{margin-bottom:.75rem;overflow-x:auto}
.team td:last-child{min-width:12rem}
.events td:first-child{font-variant-numeric:tabular-nums;color:var(--soft)}
@media (max-width:30rem){body{padding:.5rem}section,.tiles div{padding:.5rem .6rem}}
@media (min-width:44rem),print{.tiles{grid-template-columns:repeat(4,1fr)}}
@media print{body{background:none;padding:0;max-width:none;font-size:10pt}section,.tiles div,tr{break-inside:avoid}
.columns{grid-template-columns:1fr 1fr}
#slider,.path label,#bumps{display:none}.events{break-inside:auto}svg{max-height:16cm}
*{-webkit-print-color-adjust:exact;print-color-adjust:exact}}
'''
PAGE = {'page': ('#eceef1', '#1b1e23'), 'card': ('#ffffff', '#20252c'), 'soft': ('#545e6a', '#a6afbb'),
        'body': ('#343b45', '#343b45'), 'robot': (ROBOTS[0], ROBOTS[0])}
