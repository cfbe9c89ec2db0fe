// What the page uses of three.js; README.md says how three.js is made from this list.
export {
    AmbientLight, BackSide, BufferAttribute, BufferGeometry, Color, CylinderGeometry, DirectionalLight, FrontSide, Group,
    InstancedMesh, Matrix4, Mesh, MeshBasicMaterial, MeshLambertMaterial, OrthographicCamera, Quaternion, Raycaster, Scene,
    SRGBColorSpace, Vector2, Vector3, WebGLRenderer,
} from "three";
export { OrbitControls } from "three/addons/controls/OrbitControls.js";
