/**
 * What the core says in English about fields, choices and species, in Chinese. The English is the key, so that a text that
 * changes is not left with an old translation: `help.test.ts` holds this table against the core's own schemas.
 */
export const zhHelp: Readonly<Record<string, string>> = {
  // Flowers
  'How a flower looks, and on which day.': '花的样子，以及处于第几天。',
  'Days since the bud: 0 is the bud, opening_days full bloom, then it wilts. 0 to 100, default 4.':
    '从花蕾算起的天数：0 为花蕾，到“盛开所需天数”时盛开，之后凋谢。0 至 100，默认 4。',
  'Angle by which the open flower nods, degrees, 0 to 90; default that of the species.':
    '盛开的花低垂的角度，度，0 至 90；默认随种类。',
  'Days from bud to full bloom, 0.1 to 60; default those of the species.':
    '从花蕾到盛开的天数，0.1 至 60；默认随种类。',
  'The species.': '种类。',
  'Length of the stalk, metres, 0 to 5; default that of the species.': '花柄的长度，米，0 至 5；默认随种类。',
  'Days from full bloom to wilted, 0.1 to 40; default those of the species.':
    '从盛开到凋谢的天数，0.1 至 40；默认随种类。',
  // Measured leaves
  'How a leaf is made of its marks.': '如何由测量的标记点做出叶片。',
  'What colours a measured blade.': '测量叶片的着色方式。',
  'Painted by the distance from the veins.': '按到叶脉的距离着色。',
  'One green.': '单一的绿色。',
  'The rings of veins.': '叶脉的截面环。',
  'Circles across the vein, as published.': '垂直于叶脉的圆，与论文一致。',
  'Where each ball touches the surface of all.': '每个球与整体包络面相切之处。',
  'The surface of a measured blade.': '测量叶片的曲面。',
  'Through all marks, with the folds of the blade.': '通过所有标记点，保留叶面的褶皱。',
  'A B-spline near the marks.': '逼近标记点的 B 样条。',
  'One smooth polynomial.': '单一的光滑多项式曲面。',
  'As approximate, drawn towards thick veins.': '同样逼近标记点，并被粗脉吸引。',
  'What a measured thickness is.': '测得的厚度指什么。',
  'As callipers measure.': '卡尺量得的直径。',
  'As the formulas take it.': '公式所用的半径。',
  'Round ends on the veins; default false.': '叶脉末端是否为圆头；默认否。',
  'Roll about the midrib: -1 (margins meet below) to 1 (above), 0 as measured, default 0.':
    '绕中脉卷曲：-1（叶缘在下方相接）至 1（在上方相接），0 为实测形态，默认 0。',
  'Length of the midrib for a vein graph in pixels, metres, 0.002 to 10, default 0.1.':
    '叶脉图以像素为单位时中脉的长度，米，0.002 至 10，默认 0.1。',
  'A vein along the margin too; default false.': '叶缘是否也有一条叶脉；默认否。',
  'Rings of the veins.': '叶脉的截面环。',
  'Points around a vein, 3 to 64, default 10.': '叶脉一圈的点数，3 至 64，默认 10。',
  'Parts of each span between marks, 1 to 64, default 5.': '相邻标记点之间细分的段数，1 至 64，默认 5。',
  'Surface of the blade.': '叶片的曲面。',
  'Colour of the blade.': '叶片的着色。',
  'What a measured thickness is; default what the file says, else the diameter.':
    '测得的厚度指什么；默认依文件所述，否则为直径。',
  'Pull of the thickest vein on a NURBS blade, 1 (none) to 100, default 4.':
    '最粗叶脉对 NURBS 曲面的吸引力，1（无）至 100，默认 4。',
  'Loss of stiffness: 0 as measured to 1 hanging limp, default 0.':
    '失去挺度的程度：0 为实测形态，1 为完全下垂，默认 0。',
  // Trees
  'A kind of tree, where it stands and how it looks. Metres, degrees, +Y up; saved as TOML.':
    '一种树：长在何处、是何样子。单位为米和度，+Y 向上；以 TOML 保存。',
  'One line about it.': '一句话简介。',
  'The trees as they were after so many rounds, years (self-organising) or rewriting steps (L-systems); default none: to the end.':
    '树在若干轮、若干年（自组织）或若干次改写（L 系统）之后的样子；默认不限：直到长成。',
  'No leaves at all: a dead or winter tree. Default false.': '完全无叶：枯树或冬态。默认否。',
  'The form of a leaf.': '叶的形状。',
  'Flowers in the place of some leaves. Default none.': '部分叶位上开花。默认无花。',
  'Distance that bark keeps from obstacles where there is room, metres, 0 to 1e6, default 0.05; leaves may touch.':
    '有空间处树皮与障碍物保持的距离，米，0 至 1e6，默认 0.05；叶可以触及。',
  'How leaves stand, and how many fall.': '叶片如何着生，又落去多少。',
  'Colours and bark.': '颜色与树皮。',
  'How they grow.': '生长方法。',
  'For files and reports.': '用于文件和报告的名称。',
  'What they grow around; meshes may be named by file, in metres, +Y up. Default nothing.':
    '树绕着生长的障碍物；网格可用文件名给出，以米为单位，+Y 向上。默认无。',
  'Where trees of this kind stand, metres; they compete. Default one at the origin.':
    '此种树的位置，米；它们相互竞争。默认一棵，位于原点。',
  'Scientific name; may be empty.': '学名；可为空。',
  'How skeletons become wood.': '骨架如何长成木质。',
  // Phyllotaxis
  'How buds or leaves stand around their axis.': '芽或叶绕轴的排列，即叶序。',
  'One a node, turned by the divergence from the one before.': '每节一枚，依次转过发散角。',
  'Degrees; 137.5 in most plants.': '度；多数植物为 137.5。',
  'One a node, in two rows.': '每节一枚，排成两列。',
  'Two a node, all in one plane.': '每节两枚，都在同一平面。',
  'Two a node, each pair across the one before.': '每节两枚，相邻两对互相垂直。',
  'Several a node, 2 to 12.': '每节数枚，2 至 12。',
  'How many.': '数目。',
  'How buds stand, default a golden spiral.': '芽的叶序，默认黄金角螺旋。',
  'How axillary buds stand, default a golden spiral.': '腋芽的叶序，默认黄金角螺旋。',
  'How they stand around the shoot, default a golden spiral.': '叶绕枝条的叶序，默认黄金角螺旋。',
  // Bark and look
  'What the bark is like.': '树皮的样子。',
  'Ridges and furrows along the trunk: oak, poplar, willow.': '沿树干的脊与沟：栎、杨、柳。',
  'Without plates: beech, young trees, shrubs.': '光滑不裂：水青冈、幼树、灌木。',
  'Large flakes with dark cracks: pine, plane.': '大块鳞片，裂缝深色：松、悬铃木。',
  'White paper with dark stripes across: birch.': '白色纸状，有深色横纹：桦。',
  'Rings that fallen leaves have left: palm.': '落叶留下的环痕：棕榈。',
  'Smooth and jointed: bamboo.': '光滑有节：竹。',
  'Colours and bark. All colours are sRGB.': '颜色与树皮。所有颜色均为 sRGB。',
  'An sRGB colour, written #rrggbb.': 'sRGB 颜色，写作 #rrggbb。',
  'Mean colour of the bark of trunk and branches.': '树干和枝条树皮的平均颜色。',
  'Colour of the bark at the foot of the trunk, old and rough, not lighter than bark_color; default the same.':
    '树干基部老而粗糙的树皮颜色，不比“树皮颜色”更浅；默认与之相同。',
  "Share of the tree's height up to which the foot's colour reaches, 0.01 to 1, default 0.2.":
    '基部颜色所达的高度占树高的比例，0.01 至 1，默认 0.2。',
  'Colour of leaves.': '叶片的颜色。',
  'Colour towards which single leaves vary (autumn, young growth); default that of leaves.':
    '个别叶片偏向的颜色（秋叶、新叶）；默认与叶色相同。',
  'How far they vary, 0 to 1, default 0.5.': '叶色变化的幅度，0 至 1，默认 0.5。',
  'Mean colour of the bark of twigs.': '小枝树皮的平均颜色。',
  // Forms of leaves
  'A botanical form.': '植物学上的叶形。',
  'Broadest below the middle, drawn-out tip: pear, birch, poplar.': '中部以下最宽，先端渐尖：梨、桦、杨。',
  'Broadest in the middle: beech.': '中部最宽：水青冈。',
  'Broadest above the middle: Terminalia, magnolia.': '中部以上最宽：榄仁树、木兰。',
  'Narrow: willow, olive, bamboo.': '狭长：柳、油橄榄、竹。',
  'Heart-shaped: lime.': '心形：椴。',
  'Nearly a triangle on a broad base: poplar, birch.': '基部宽阔，近三角形：杨、桦。',
  'Round lobes on both sides: oak.': '两侧有圆形裂片：栎。',
  'Five pointed lobes from one place: maple, plane.': '五枚尖裂片自一处伸出：槭、悬铃木。',
  'Leaflets in pairs along a midrib: ash, walnut, rowan.': '小叶沿叶轴成对排列：白蜡、胡桃、花楸。',
  'A long narrow leaflet: palm, grass.': '狭长的小叶：棕榈、禾草。',
  'One needle.': '单根针叶。',
  'A bundle of needles that spread from one place: pine, larch.': '自一处散开的一束针叶：松、落叶松。',
  'A short shoot with needles on both sides: fir, spruce, yew.': '两侧生针叶的短枝：冷杉、云杉、红豆杉。',
  "A leaf's form.": '叶的形状。',
  "How far the tip bends down, as a share of the length, -1 to 1; default the form's.":
    '叶尖下弯的程度，占叶长的比例，-1 至 1；默认随叶形。',
  'A leaf of your own instead of the form: marks (.csv), a vein graph (.json) or a model of one leaf (.glb, .obj, .ply, .stl), relative to the spec. Default none.':
    '用自己的叶代替叶形：标记点（.csv）、叶脉图（.json）或单叶模型（.glb、.obj、.ply、.stl），路径相对于设定文件。默认无。',
  "Slope of the halves along the midrib, -1 to 2; default the form's.":
    '两半叶沿中脉对折的坡度，-1 至 2；默认随叶形。',
  'The form, default ovate. A file goes before it.': '叶形，默认卵形。若给出文件，以文件为准。',
  "Width relative to the form's usual, 0.1 to 4; default 1.":
    '相对于该叶形通常宽度的倍数，0.1 至 4；默认 1。',
  // Blossom
  'What flowers a tree bears where leaves would stand.': '树在叶位上开的花。',
  'Colour of petals, default a white.': '花瓣的颜色，默认白色。',
  'Colour towards which single flowers vary; default none.': '个别花朵偏向的颜色；默认无。',
  'Across an open flower, metres, default 0.035.': '盛开花朵的直径，米，默认 0.035。',
  "Petals of a flower's whorl, 3 to 12, default 5.": '每轮花瓣的数目，3 至 12，默认 5。',
  "Share of the leaves' places that bear a flower instead, 0 to 1, default 0: no flowers.":
    '开花的叶位所占比例，0 至 1，默认 0：无花。',
  "Whorls of petals, one within the other, 1 to 6, default 1; 3 and more make a double flower such as a rose's.":
    '内外相套的花瓣轮数，1 至 6，默认 1；3 轮及以上成为重瓣花，如蔷薇。',
  // Leaves of trees
  'What leaves a tree bears.': '树上的叶。',
  'Between shoot and blade, degrees, 0 to 180, default 55.': '枝条与叶片的夹角，度，0 至 180，默认 55。',
  'How far blades hang, -1 to 1 (all down), default 0.15.':
    '叶片下垂的程度，-1 至 1（完全朝下），默认 0.15。',
  'Share of the leaves kept, the best lit ones, 0 to 1; default 1. Many, suitable and few in Fig 11 of paper 001.':
    '保留的叶片比例，先留受光最好的，0 至 1；默认 1。即论文 001 图 11 的多、适中与少。',
  'Length of a blade, metres, above 0, default 0.09.': '叶片长度，米，大于 0，默认 0.09。',
  'Most leaves that are considered, default 2 million.': '最多考虑的叶片数，默认 200 万。',
  'Shoots bear leaves where they are not thicker than this, metres; default 0.009: two of the usual tips.':
    '枝条不粗于此半径处才生叶，米；默认 0.009，相当于两根通常的枝梢。',
  'Leaves with less light fall in any case, 0 or more (full light is 1), default 0.':
    '光照低于此值的叶片必定脱落，0 或以上（全光照为 1），默认 0。',
  'Whether a leaf suffers from its own shadow, as in the paper (Palubicki adds it back). Default false.':
    '叶片是否受自身阴影影响，如论文所述（Palubicki 会把它加回）。默认否。',
  'What a leaf adds to the shadow of its own voxel (k of Eq 5), above 0, default 0.03.':
    '一片叶给所在体素增加的阴影（式 5 的 k），大于 0，默认 0.03。',
  'The fall of the shadow from layer to layer (b of Eq 5), above 1, default 1.8.':
    '阴影逐层衰减的倍数（式 5 的 b），大于 1，默认 1.8。',
  'Layers below a leaf that it shades, 1 to 32, default 6.': '叶片之下受遮荫的层数，1 至 32，默认 6。',
  'Standard deviation of the length as a share of it, 0 to 0.5, default 0.1.':
    '叶长的标准差占叶长的比例，0 至 0.5，默认 0.1。',
  'Between two nodes of a shoot, metres, above 0, default 0.06.':
    '枝条上相邻两节的距离，米，大于 0，默认 0.06。',
  'Side of a voxel, metres; default two blade lengths.': '体素的边长，米；默认为叶长的两倍。',
  'Width over length of the blade that blade makes, 0.01 to 3, default 0.5.':
    '所选叶形的宽长比，0.01 至 3，默认 0.5。',
  // Growth
  'How a tree grows.': '树如何生长。',
  'Space colonisation (Runions 2007).': '空间殖民算法（Runions 2007）。',
  'Space colonisation of points that are given instead of scattered.':
    '空间殖民算法，吸引点由人给出而非随机散布。',
  'Competition for space in life cycles (paper 001).': '按生命周期竞争空间（论文 001）。',
  'Buds that compete for light (Palubicki 2009).': '芽竞争光照的自组织生长（Palubicki 2009）。',
  "Buds with markers of their own that keep away from others' and follow strokes of a brush (paper 002).":
    '每个芽有自己的标记点，避让其他芽，并沿笔刷的笔画生长（论文 002）。',
  'Rules (Prusinkiewicz and Lindenmayer 1990). Obstacles cut off what grows into them.':
    'L 系统规则（Prusinkiewicz 与 Lindenmayer 1990）。长进障碍物的部分被截去。',
  'How branches grow towards attraction points.': '枝条如何朝吸引点生长。',
  'Distances and pulls.': '距离与牵引。',
  'Attraction points for each tree, 1 to 10 million.': '每棵树的吸引点数，1 至 1000 万。',
  'Attraction points, metres; not relative to a root.': '吸引点，米；不以树根为原点。',
  'Share of the envelope left empty inside, 0 to 0.99.': '包络内部留空的比例，0 至 0.99。',
  'Share of the envelope left empty inside, 0 to 0.99, default 0.': '包络内部留空的比例，0 至 0.99，默认 0。',
  'Distance d_i within which a joint perceives a point, metres, above 0, default 1.':
    '节点能感知吸引点的距离 d_i，米，大于 0，默认 1。',
  'Share of the last direction kept in each step, 0 to 10, default 0.':
    '每步保留上一步方向的份量，0 至 10，默认 0。',
  'Distance d_k at which a point is consumed, metres, above 0 and at most attraction_m (else that is raised to it, with a warning), default 0.4.':
    '吸引点被吸收的距离 d_k，米，大于 0 且不超过“吸引距离”（否则后者升到此值并给出警告），默认 0.4。',
  'Growth stops, with a warning, at this many joints; 1 to 2^31, default 4 million.':
    '节点达到此数时停止生长并给出警告；1 至 2^31，默认 400 万。',
  'A point steers one step before it is consumed, as in paper 001, instead of being consumed as soon as a joint comes near (Runions). Needed where kill_m is near attraction_m: else hardly any point steers. Default false.':
    '吸引点先引导一步再被吸收（论文 001），而非节点一靠近就被吸收（Runions）。“吸收距离”接近“吸引距离”时需要它，否则几乎没有点能引导方向。默认否。',
  'Length D of one step, metres; default half of kill_m. Above twice kill_m, points can be stepped over.':
    '每步的长度 D，米；默认为“吸收距离”的一半。大于其两倍时可能越过吸引点。',
  'What else pulls: light, gravity, wind. Default none.':
    '其他牵引：光、重力、风，即向光性、向地性等。默认无。',
  'What else pulls. Default none.': '其他牵引。默认无。',
  'Attraction distance d_i, default 0.9.': '吸引距离 d_i，默认 0.9。',
  'Height of that ball over its width, 0 to 4: small values make flat tiers. Default 1.':
    '该球的高宽比，0 至 4：小值形成扁平的层。默认 1。',
  'Radius of the ball of those points; default d_i.': '新点所在球的半径；默认 d_i。',
  'The space that the first cycle fills, if it is another: a narrow one makes a trunk with few limbs, on which later cycles grow the branches. Default none.':
    '第一个周期填充的空间若不同，在此给出：狭窄的空间形成少枝的主干，后来的周期再在其上长出枝条。默认无。',
  'Share of the joints around which each later cycle puts points (K), 0 to 1, default 0.15.':
    '之后每个周期在多大比例的节点周围放置新点（K），0 至 1，默认 0.15。',
  'Absorption distance d_k, default 0.4.': '吸收距离 d_k，默认 0.4。',
  'Life cycles, 1 to 20, default 2.': '生命周期数，1 至 20，默认 2。',
  'Most joints of all trees together, default 4 million.': '所有树合计的最多节点数，默认 400 万。',
  'Points of the first cycle for each tree, N; 1 to 10 million, default 1500.':
    '每棵树第一个周期的吸引点数 N；1 至 1000 万，默认 1500。',
  'Points around each of them (M), 1 to 10000, default 40.':
    '每个节点周围的新点数（M），1 至 10000，默认 40。',
  'Factor on d_i, d_k, D and the ball from one cycle to the next, 0.1 to 1, default 1 (as in the paper).':
    '每过一个周期，d_i、d_k、D 和球所乘的系数，0.1 至 1，默认 1（与论文一致）。',
  'Step D, default half of d_k (the paper does not give it; Runions asks for d_k of 2 D or more).':
    '步长 D，默认为 d_k 的一半（论文未给出；Runions 要求 d_k 不小于 2 D）。',
  'Vertical distance between the tiers of branches that grow on what the first cycle made; default none: anywhere.':
    '在第一个周期的枝干上生出的各层枝条之间的竖直距离；默认无：任意位置。',
  'Vigour per unit of light, above 0 and at most 100, default 2.':
    '每单位光照带来的活力，大于 0，至多 100，默认 2。',
  'Between a shoot and the buds at its side, 0 to 180 degrees, default 60.':
    '枝条与侧芽的夹角，0 至 180 度，默认 60。',
  'Between a shoot and the buds at its side, 0 to 180 degrees, default 55.':
    '枝条与侧芽的夹角，0 至 180 度，默认 55。',
  'Length of an internode at vigour 1, above 0, default 0.25.': '活力为 1 时节间的长度，大于 0，默认 0.25。',
  'Standard deviation of that angle and of the azimuths, 0 to 60 degrees, default 4.':
    '该夹角与方位角的标准差，0 至 60 度，默认 4。',
  'Standard deviation of that angle and of the azimuths, 0 to 60 degrees, default 6.':
    '该夹角与方位角的标准差，0 至 60 度，默认 6。',
  'Years until lambda_late holds, default 10.': '“后期顶端优势”开始生效的年数，默认 10。',
  'How buds learn their light.': '芽如何得知所受光照。',
  'How buds learn how much light they have.': '芽如何得知自己所受的光照。',
  'Weight xi of the best-lit direction, 0 to 10, default 0.25.':
    '最亮方向的权重 ξ（向光性），0 至 10，默认 0.25。',
  'Most joints of all trees together; growth stops, with a warning, before the year that would make more. Default 200,000: some six million triangles.':
    '所有树合计的最多节点数；将要超过的那一年之前停止生长并给出警告。默认 200,000：约六百万个三角形。',
  'Most internodes of one shoot a year, 1 to 100, default 6.': '一根枝条每年最多的节间数，1 至 100，默认 6。',
  'Exponent n of the pipe model, 1 to 4, default 2.4.': '管道模型的指数 n，1 至 4，默认 2.4。',
  'How it is shared.': '养分如何分配。',
  'How what was gathered is shared.': '所得的养分如何分配。',
  'Whether a bud suffers from the shadow of its own leaf (paper 001 has no correction), default false.':
    '芽是否受自身叶片阴影的影响（论文 001 不作修正），默认否。',
  'Years that a branch is spared, default 3.': '枝条在此年数之内不会脱落，默认 3。',
  'A branch with less light per internode is shed, 0 or more, default 0.15.':
    '每节间平均光照低于此值的枝条会脱落，0 或以上，默认 0.15。',
  'Radius of a fresh shoot, above 0, default 0.004.': '新枝的半径，大于 0，默认 0.004。',
  'Weight eta and direction of what else pulls, default 0.05 upwards.':
    '其他牵引的权重 η 与方向，默认 0.05，向上。',
  'Years of growth, 0 to 1000, default 25.': '生长的年数，0 至 1000，默认 25。',
  'The extended Borchert-Honda model.': '扩展的 Borchert-Honda 模型。',
  'Bias for the main axis, 0 to 1; 0.46 makes a bush, 0.54 a leader.':
    '偏向主轴的程度（顶端优势），0 至 1；0.46 长成灌丛，0.54 长出中央主干。',
  'The bias after lambda_years; default the same.': '“后期起始年”之后的顶端优势；默认不变。',
  'The priority model: weights by rank along each axis.': '优先级模型：沿每条轴按等级给权重。',
  'Rank, 1 or more.': '等级，1 或以上。',
  'Weight of the tip, above 0.': '枝梢的权重，大于 0。',
  'Weight from rank kappa on, 0 or more.': '从“等级数”起的权重，0 或以上。',
  "Shadow propagation: Q = max(C - s + a, 0), direction down the shadow's gradient.":
    '阴影传播：Q = max(C - s + a, 0)，方向为阴影减弱最快的方向。',
  'What a joint adds to its own voxel, above 0 and at most 100.':
    '一个节点给所在体素增加的阴影，大于 0，至多 100。',
  'The fall of the shadow from layer to layer, above 1 and at most 100.':
    '阴影逐层衰减的倍数，大于 1，至多 100。',
  'Full light C, above 0.': '全光照 C，大于 0。',
  'Layers below that are shaded, 1 to 32.': '其下受遮荫的层数，1 至 32。',
  'Side of a voxel, metres; default two internodes.': '体素的边长，米；默认为节间长度的两倍。',
  'Space colonisation: Q = 1 for a bud that is nearest to a free marker in its cone, else 0.':
    '空间殖民：若芽是其视锥内某个空闲标记点最近的芽，则 Q = 1，否则为 0。',
  'Where markers are, relative to the root.': '标记点所在的空间，以树根为原点。',
  'Half opening angle of the cone of sight, degrees; 45.': '视锥的半张角，度；45。',
  'How many for each tree, 1 to 10 million.': '每棵树的数目，1 至 1000 万。',
  'Radius in which a joint removes markers, internodes; 2 in the paper.':
    '节点清除标记点的半径，以节间为单位；论文中为 2。',
  'Radius in which a bud sees markers, internodes; 4 to 6 in the paper.':
    '芽能看到标记点的半径，以节间为单位；论文中为 4 至 6。',
  'Vigour per unit of free space, above 0 and at most 100, default 2.':
    '每单位空闲空间带来的活力，大于 0，至多 100，默认 2。',
  'The space of the crown, relative to the root; default none: growth ends with its rounds.':
    '树冠的空间，以树根为原点；默认无：轮数用完即停止生长。',
  'Perception radius, in internodes, above near and at most 100, default 5.':
    '感知半径，以节间为单位，大于“占据半径”，至多 100，默认 5。',
  'Half the opening of the perception cone, 1 to 180 degrees, default 45.':
    '感知锥的半张角，1 至 180 度，默认 45。',
  'Share of the main axis at a fork, 0 to 1, default 0.54.':
    '分叉处主轴所得的份额（顶端优势），0 至 1，默认 0.54。',
  'Markers of one bud in one round, N, 4 to 10000, default 60. The paper speaks of about 1300: more markers only make the course of a shoot straighter, by 34 degrees over the root of N.':
    '每轮一个芽的标记点数 N，4 至 10000，默认 60。论文中约为 1300：更多的点只使枝条更直，偏差约为 34 度除以 N 的平方根。',
  'Most joints, default 1 million.': '最多节点数，默认 100 万。',
  'Most internodes of one shoot in one round, 1 to 100, default 3.':
    '一根枝条每轮最多的节间数，1 至 100，默认 3。',
  'Occupancy radius, in internodes, 0 to 100, default 2: nearer to a bud there are no markers.':
    '占据半径，以节间为单位，0 至 100，默认 2：离芽更近处没有标记点。',
  "How strongly others' markers push away, k_r, 0 to 10, default 1.":
    '其他芽的标记点排斥的强度 k_r，0 至 10，默认 1。',
  'Rounds of growth, 0 to 1000, default 14.': '生长的轮数，0 至 1000，默认 14。',
  'Twigs of at most so many internodes that stopped growing are shed at the end, 0 (none) to 1000; default 1.':
    '已停止生长且不超过此节间数的小枝最后脱落，0（不脱落）至 1000；默认 1。',
  'Strokes that guide it; with any, buds grow only inside them. Default none.':
    '引导生长的笔画；有笔画时芽只在其中生长。默认无。',
  'Weight and light, k_g g; relative to the pull of free space. Default 0.12 upwards.':
    '重力与光的牵引 k_g g；相对于空闲空间的牵引。默认 0.12，向上。',
  'A stroke of a brush in space: buds find room only inside it, and are drawn along it (paper 002).':
    '空间中的一笔：芽只在其中找到空间，并沿笔画生长（论文 002）。',
  'Its course, metres, at least two points.': '笔画的路径，米，至少两点。',
  'Pull along the stroke, k_s, 0 to 10; default 1.': '沿笔画的牵引 k_s，0 至 10；默认 1。',
  'Radius, metres, above 0: one number, or one for each point.': '半径，米，大于 0：一个数，或每点一个。',
  'Most modules of all trees, 1 to 100 million.': '所有树的最多模块数，1 至 1 亿。',
  'The text that Lsystem::parse reads.': 'L 系统的规则文本。',
  'A pull in one direction: light from above, weight downwards, wind.':
    '朝一个方向的牵引：上方的光（向光性）、向下的重力（向地性）、风。',
  'Where to; any length above 0.': '方向；长度大于 0 即可。',
  'Relative to the pull of free space (which is 1), -10 to 10.': '相对于空闲空间的牵引（为 1），-10 至 10。',
  // The space of the crown
  'The space that a crown may fill. Metres, +Y up.': '树冠可以填充的空间。单位为米，+Y 向上。',
  'The space of the crown, relative to the root.': '树冠的空间，以树根为原点。',
  'The space of the crown.': '树冠的空间。',
  'A ball.': '球。',
  'Its middle.': '中心。',
  'Above 0.': '大于 0。',
  'A ball stretched along the axes.': '沿坐标轴拉伸的球。',
  'Half its extents, each above 0.': '各方向长度的一半，均大于 0。',
  'An upright cone, its point up.': '直立的圆锥，尖端朝上。',
  'Middle of its base.': '底面的中心。',
  'Radius of its base, above 0.': '底面的半径，大于 0。',
  'An upright cylinder.': '直立的圆柱。',
  'A surface of revolution about the vertical through base.': '绕过“底部”的竖直轴旋转而成的曲面。',
  'Where the heights of the profile start.': '轮廓高度的起点。',
  '(radius, height), at least 2 points, heights rising, radii 0 or more.':
    '（半径，高度），至少 2 点，高度递增，半径不小于 0。',
  'A closed outline drawn in the plane z = centre_z; across the plane each height is as deep as it is wide.':
    '画在平面 z = centre_z 上的闭合轮廓；在每个高度上，纵深与宽度相同。',
  'The plane of the drawing.': '画面所在的平面。',
  'Depth over width, above 0; 1 gives round sections.': '纵深与宽度之比，大于 0；1 时截面为圆形。',
  'At least 3 points.': '至少 3 点。',
  'A closed mesh. Small holes and inverted faces are borne (winding number).':
    '闭合网格。容许小孔和反向的面（按环绕数判断）。',
  'Corners of each triangle.': '每个三角形的顶点编号。',
  'Vertices.': '顶点。',
  'A cloud of points: the space within reach_m of any of them.': '点云：离任一点不超过“影响范围”的空间。',
  'At least one usable point.': '至少一个可用的点。',
  // Obstacles
  'A solid thing. Metres, +Y up.': '实心物体。单位为米，+Y 向上。',
  'A box along the axes.': '与坐标轴对齐的方块。',
  'Upper corner, above the lower one in each coordinate.': '上角，各坐标均大于下角。',
  'Lower corner.': '下角。',
  'Everything behind a plane: a wall, a slope.': '平面之后的一切：墙、坡。',
  'Away from the solid side; any length above 0.': '背离实心一侧的方向；长度大于 0 即可。',
  'Any point of the plane.': '平面上任意一点。',
  'A mesh, in metres, +Y up; small holes and inverted faces are borne (winding number).':
    '网格，以米为单位，+Y 向上；容许小孔和反向的面（按环绕数判断）。',
  // Wood
  'How a skeleton becomes wood.': '骨架如何长成木质。',
  "What every internode adds to the pipes, as a share of a tip's, 0 to 1, default 0.05. It makes shoots taper between forks; 0 is Eq 4 to the letter.":
    '每个节间为管道增加的量，以枝梢为 1，0 至 1，默认 0.05。它使枝条在分叉之间渐细；0 即严格按式 4。',
  'Exponent t of r^t = sum of r_i^t (paper 001, Eq 4), 1 to 4, default 2.4; trees are measured at 1.8 to 2.6.':
    '管道模型 r^t = Σ r_i^t 的指数 t（论文 001 式 4），1 至 4，默认 2.4；实测树木为 1.8 至 2.6。',
  'How often every joint is moved half-way to the one it grew from (Runions 2007, step e), 0 to 10: angles at forks become acute and courses straighter; each time costs half an internode of size. Default 1.':
    '每个节点向其母节点移动一半的次数（Runions 2007 步骤 e），0 至 10：分叉变锐，枝条变直；每次使树缩小半个节间。默认 1。',
  'Smooths courses to quadratic Bezier pieces that join with one tangent (Eq 3, C1 variant). Default true.':
    '把枝条平滑为切线相接的二次贝塞尔曲线（式 3，C1 变体）。默认是。',
  'Joints that bear nothing are left out where this takes the course aside by less than this share of the radius, 0 to 10, default 0.25.':
    '不生枝的节点若略去后偏移小于半径的此比例，则略去，0 至 10，默认 0.25。',
  'Radius of a tip, metres, above 0, default 0.004.': '枝梢的半径，米，大于 0，默认 0.004。',
  'Radius at the foot of the thickest trunk, metres; what lies between it and the tips is stretched in proportion. Default none: as the pipe model has it.':
    '最粗树干基部的半径，米；其与枝梢之间按比例拉伸。默认无：由管道模型决定。',
  // Species
  'Scots pine of the paper: clear orange trunk, irregular crown of needle tufts':
    '论文中的欧洲赤松：光洁的橙色树干，针叶成束，树冠不规则',
  'Madagascar almond of the paper: flat tiers, leaves in rosettes':
    '论文中的小叶榄仁：枝条平展成层，叶聚生如莲座',
  'Chinese fir of the paper: a slender cone, branches that hang a little':
    '论文中的杉木：瘦长圆锥形，枝条微垂',
  'a broad oak by competition for space in three life cycles': '宽阔的夏栎，经三个生命周期竞争空间长成',
  'the same oak by space colonization, for burgeon compare oak':
    '同一株栎，用空间殖民算法，供 burgeon compare oak 比较',
  'the same oak by an L-system, for burgeon compare oak': '同一株栎，用 L 系统，供 burgeon compare oak 比较',
  'a silver birch: white bark, dark at the foot, fine hanging twigs':
    '垂枝桦：树皮白色，基部深色，小枝纤细下垂',
  'a lime: dense rounded crown of heart-shaped leaves': '椴树：树冠浓密圆整，叶心形',
  'a maple in autumn: dense egg-shaped crown, palmate leaves': '秋天的槭树：树冠浓密卵形，叶掌状',
  'a Norway spruce: a dense cone, branches down to the ground': '挪威云杉：浓密圆锥形，枝条垂及地面',
  'a weeping willow: curtains of hanging shoots': '垂柳：枝条如帘垂下',
  'a Lombardy poplar: a column of steep branches': '钻天杨：枝条陡立，成柱形',
  'a coconut palm: leaning ringed stem, arching fronds': '椰子：茎倾斜有环纹，羽叶拱垂',
  'a clump of bamboo: jointed canes, sprays of narrow leaves': '一丛竹：竿有节，叶狭长成簇',
  'a hazel bush: many stems from the ground, round leaves': '榛丛：自地面生出多茎，叶圆形',
  'a dead oak: bare, grey, without its fine twigs': '枯栎：光秃灰色，细枝尽落',
  'a black alder by competition for light: straight stem, open conical crown':
    '竞争光照长成的欧洲桤木：主干通直，树冠疏朗圆锥形',
  'an Italian stone pine: tall bare trunk under a flat parasol': '意大利伞松：高而光洁的树干，顶着平伞形树冠',
  'an Italian cypress: a dark, dense column that ends in a point': '意大利柏：深绿浓密的柱形，顶端尖细',
  'a cherry tree in blossom: clusters of pink flowers, few young leaves': '盛开的樱：粉花成簇，嫩叶稀少',
  'a shrub rose in flower: arching stems from the ground, double blooms':
    '开花的灌丛蔷薇：茎自地面拱起，花重瓣',
  'a tuft of fountain grass: arching leaves, feathery plumes': '一丛狼尾草：叶拱垂，花序如羽',
};
