"""A 3-D view as HTML that needs nothing else: the meshes are in it, WebGL 2 draws them."""

from __future__ import annotations

import base64
import html
import json
from typing import TYPE_CHECKING, Any, Dict

from . import _burgeon
from ._given import beyond

if TYPE_CHECKING:
    from .model import Model, Part

MOST_TRIANGLES = 120_000
"""What a notebook keeps well: about 5 MB."""


def page(model: "Model", height: int) -> str:
    """An ``iframe`` with the view: nothing of it meets what else is on the page."""
    if not 64 <= height <= 4096:
        raise beyond("height", height, "64 to 4096 pixels")
    import numpy as np

    parts = [p for p in model.parts if len(p.faces)]
    corners = [np.array([p.vertices.min(0), p.vertices.max(0)]) for p in parts]
    low = np.min([c[0] for c in corners], axis=0) if corners else np.zeros(3)
    high = np.max([c[1] for c in corners], axis=0) if corners else np.ones(3)
    data = {"low": low.tolist(), "high": high.tolist(), "parts": [_part(p) for p in parts]}
    text = _PAGE.replace("/*data*/", json.dumps(data).replace("</", "<\\/"))
    frame = html.escape(text, quote=True)
    style = f"width:100%;height:{height}px;border:0;border-radius:6px"
    return f'<iframe srcdoc="{frame}" style="{style}" title="{html.escape(model.name)}" sandbox="allow-scripts"></iframe>'


def _packed(values: Any, kind: str) -> str:
    import numpy as np

    return base64.b64encode(np.ascontiguousarray(values, kind).tobytes()).decode()


def _part(part: "Part") -> "Dict[str, Any]":
    import numpy as np

    material = part.material
    base = np.float32(material["base_color"])
    colors = part.colors * base if len(part.colors) else np.broadcast_to(base, part.vertices.shape)
    normals = np.zeros((len(part.vertices), 4), np.int8)
    normals[:, :3] = np.rint(127 * part.normals)
    rgba = np.full((len(part.vertices), 4), 255, np.uint8)
    # The square root keeps dark colours apart in eight bits; the shader squares them.
    rgba[:, :3] = np.rint(255 * np.sqrt(np.clip(colors, 0, 1)))
    out = {
        "positions": _packed(part.vertices, "<f4"),
        "normals": _packed(normals, "i1"),
        "colors": _packed(rgba, "u1"),
        "faces": _packed(part.faces, "<u4"),
        "cut": bool(material["cut_out"]),
        "blade": bool(material["double_sided"]),
    }
    texture = part.texture
    if texture is not None and len(part.uvs):
        # A view of a notebook shows no more.
        step = max(1, max(texture.shape[:2]) // 256)
        small = np.ascontiguousarray(texture[::step, ::step])
        rows, columns, _ = small.shape
        out["uvs"] = _packed(part.uvs, "<f4")
        out["texture"] = base64.b64encode(bytes(_burgeon.png(columns, rows, small.tobytes()))).decode()
    return out


_PAGE = """<!doctype html><meta charset="utf-8"><style>
html,body{margin:0;height:100%;overflow:hidden;background:#e9eef2}canvas{width:100%;height:100%;display:block;
touch-action:none;cursor:grab}p{position:absolute;left:12px;top:6px;font:13px sans-serif;color:#444}</style>
<canvas tabindex="0" aria-label="The plant: drag to turn, wheel to come nearer"></canvas><p hidden></p><script>
const data=/*data*/;
const canvas=document.querySelector('canvas'),note=document.querySelector('p');
const gl=canvas.getContext('webgl2',{antialias:true});
const say=t=>{note.hidden=false;note.textContent=t};
const bytes=b=>Uint8Array.from(atob(b),c=>c.charCodeAt(0));
if(!gl)say('This browser has no WebGL 2: see the picture instead.');else start();
function start(){
const shader=(kind,text)=>{const s=gl.createShader(kind);gl.shaderSource(s,text);gl.compileShader(s);
 if(!gl.getShaderParameter(s,gl.COMPILE_STATUS))say(gl.getShaderInfoLog(s));return s};
const program=gl.createProgram();
gl.attachShader(program,shader(gl.VERTEX_SHADER,`#version 300 es
in vec3 at;in vec3 normal;in vec3 color;in vec2 uv;uniform mat4 view;out vec3 n;out vec3 c;out vec2 t;
void main(){n=normal;c=color*color;t=uv;gl_Position=view*vec4(at,1.);}`));
gl.attachShader(program,shader(gl.FRAGMENT_SHADER,`#version 300 es
precision highp float;in vec3 n;in vec3 c;in vec2 t;uniform sampler2D picture;uniform bool textured,cut,blade;
uniform vec3 eye;out vec4 o;
void main(){vec3 k=c;if(textured){vec4 p=texture(picture,t);if(cut&&p.a<.5)discard;k*=pow(p.rgb,vec3(2.2));}
vec3 m=normalize(n);if(dot(m,eye)<0.&&blade)m=-m;vec3 sun=normalize(vec3(.45,.8,.5));
float d=max(dot(m,sun),0.),b=blade?max(dot(-m,sun),0.)*.45:0.;
vec3 sky=mix(vec3(.34,.31,.26),vec3(.62,.7,.8),.5+.5*m.y);
k*=sky+vec3(1.9,1.8,1.6)*d+vec3(1.3,1.4,.6)*b;k=k/(1.+.25*k);o=vec4(pow(k,vec3(1./2.2)),1.);}`));
gl.linkProgram(program);gl.useProgram(program);
const place=n=>gl.getUniformLocation(program,n);
const meshes=data.parts.map(p=>{const vao=gl.createVertexArray();gl.bindVertexArray(vao);
 const put=(name,data,size,kind,norm,step)=>{const row=gl.getAttribLocation(program,name);if(row<0||!data)return;
  gl.bindBuffer(gl.ARRAY_BUFFER,gl.createBuffer());gl.bufferData(gl.ARRAY_BUFFER,bytes(data),gl.STATIC_DRAW);
  gl.enableVertexAttribArray(row);gl.vertexAttribPointer(row,size,kind,norm,step,0)};
 put('at',p.positions,3,gl.FLOAT,false,12);put('normal',p.normals,3,gl.BYTE,true,4);
 put('color',p.colors,3,gl.UNSIGNED_BYTE,true,4);put('uv',p.uvs,2,gl.FLOAT,false,8);
 const faces=bytes(p.faces);gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER,gl.createBuffer());
 gl.bufferData(gl.ELEMENT_ARRAY_BUFFER,faces,gl.STATIC_DRAW);
 const mesh={vao,count:faces.length/4,cut:p.cut,blade:p.blade,texture:null};
 if(p.texture){const image=new Image();image.onload=()=>{mesh.texture=gl.createTexture();
  gl.bindTexture(gl.TEXTURE_2D,mesh.texture);gl.texImage2D(gl.TEXTURE_2D,0,gl.RGBA,gl.RGBA,gl.UNSIGNED_BYTE,image);
  gl.generateMipmap(gl.TEXTURE_2D);draw()};image.src='data:image/png;base64,'+p.texture}
 return mesh});
const middle=[0,1,2].map(i=>(data.low[i]+data.high[i])/2);
const reach=Math.max(1e-6,Math.hypot(...[0,1,2].map(i=>data.high[i]-data.low[i]))/2);
let turn=.55,rise=.21,far=1;
function draw(){const w=canvas.clientWidth*devicePixelRatio|0,h=canvas.clientHeight*devicePixelRatio|0;
 if(!w||!h)return;canvas.width=w;canvas.height=h;gl.viewport(0,0,w,h);
 gl.clearColor(.914,.933,.949,1);gl.clear(gl.COLOR_BUFFER_BIT|gl.DEPTH_BUFFER_BIT);gl.enable(gl.DEPTH_TEST);
 const s=Math.sin(turn),c=Math.cos(turn),a=Math.sin(rise),b=Math.cos(rise);
 const back=[s*b,a,c*b],right=[c,0,-s],up=[-s*a,b,-c*a];
 const f=1/Math.tan(.25),away=far*reach/Math.sin(.25)/Math.min(1,w/h);
 const eye=middle.map((m,i)=>m+back[i]*away),near=Math.max(away-2*reach,away*.01),end=away+2*reach;
 const dot=(u,v)=>u[0]*v[0]+u[1]*v[1]+u[2]*v[2];
 const k=(end+near)/(near-end),q=2*end*near/(near-end),x=f*h/w;
 const view=[];for(let i=0;i<3;i++)view.push(right[i]*x,up[i]*f,back[i]*k,-back[i]);
 view.push(-dot(right,eye)*x,-dot(up,eye)*f,-dot(back,eye)*k+q,dot(back,eye));
 gl.uniformMatrix4fv(place('view'),false,view);gl.uniform3fv(place('eye'),back);
 for(const m of meshes){gl.bindVertexArray(m.vao);gl.uniform1i(place('textured'),m.texture?1:0);
  gl.uniform1i(place('cut'),m.cut?1:0);gl.uniform1i(place('blade'),m.blade?1:0);
  if(m.texture)gl.bindTexture(gl.TEXTURE_2D,m.texture);
  gl.drawElements(gl.TRIANGLES,m.count,gl.UNSIGNED_INT,0)}
 canvas.dataset.drawn=1}
const fingers=new Map();let apart=0;
canvas.onpointerdown=e=>{canvas.setPointerCapture(e.pointerId);fingers.set(e.pointerId,[e.clientX,e.clientY]);apart=0};
canvas.onpointerup=canvas.onpointercancel=e=>{fingers.delete(e.pointerId);apart=0};
canvas.onpointermove=e=>{const last=fingers.get(e.pointerId);if(!last)return;fingers.set(e.pointerId,[e.clientX,e.clientY]);
 if(fingers.size===1){turn-=(e.clientX-last[0])*.01;rise=Math.max(-1.5,Math.min(1.5,rise+(e.clientY-last[1])*.01))}
 else{const [p,q]=[...fingers.values()],now=Math.hypot(p[0]-q[0],p[1]-q[1]);if(apart)nearer(apart/now);apart=now}draw()};
const nearer=by=>{far=Math.max(.05,Math.min(5,far*by))};
canvas.addEventListener('wheel',e=>{e.preventDefault();nearer(Math.exp(e.deltaY*.001));draw()},{passive:false});
canvas.onkeydown=e=>{const step={ArrowLeft:[.1,0,1],ArrowRight:[-.1,0,1],ArrowUp:[0,.1,1],ArrowDown:[0,-.1,1],
 '+':[0,0,.9],'-':[0,0,1.1]}[e.key];if(!step)return;e.preventDefault();turn+=step[0];
 rise=Math.max(-1.5,Math.min(1.5,rise+step[1]));nearer(step[2]);draw()};
new ResizeObserver(draw).observe(canvas);draw()}
</script>"""
