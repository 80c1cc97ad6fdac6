// How one side of a stream holds back, drawn by the `seed` of the module that includes this: 0 never, 1 half the time,
// 2 mostly, 3 for 256 clocks at a time.
function pause(input integer pattern, input integer clocks);
    case (pattern)
        0:       pause = 0;
        1:       pause = $random(seed);
        2:       pause = ($random(seed) & 3) != 0;
        default: pause = clocks & 256 ? 1'b1 : 1'b0;
    endcase
endfunction
